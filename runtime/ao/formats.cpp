#include "ao/formats.h"

namespace obscura::ao {
namespace {

struct Known {
    VkFormat format;
    uint32_t bytes;
    uint32_t roles;  // bits
};

constexpr uint32_t bit(Role role) { return 1u << uint32_t(role); }
constexpr uint32_t kDeviceDepth = bit(Role::deviceDepth), kSigned = bit(Role::signedNormals), kUnsigned = bit(Role::unsignedNormals),
                   kMotion = bit(Role::motion);
constexpr uint32_t kNormals = kSigned | kUnsigned, kTwo = kMotion | bit(Role::second);

constexpr Known kKnown[] = {
    {VK_FORMAT_D16_UNORM, 2, kDeviceDepth},
    {VK_FORMAT_D16_UNORM_S8_UINT, 2, kDeviceDepth},
    {VK_FORMAT_X8_D24_UNORM_PACK32, 3, kDeviceDepth},
    {VK_FORMAT_D24_UNORM_S8_UINT, 3, kDeviceDepth},
    {VK_FORMAT_D32_SFLOAT, 4, kDeviceDepth},
    {VK_FORMAT_D32_SFLOAT_S8_UINT, 4, kDeviceDepth},
    {VK_FORMAT_R32_SFLOAT, 4, kDeviceDepth | bit(Role::linearDepth) | bit(Role::thickness)},
    {VK_FORMAT_R16_SFLOAT, 2, bit(Role::thickness)},
    {VK_FORMAT_R32_UINT, 4, bit(Role::packedNormals)},
    {VK_FORMAT_R8G8B8A8_SNORM, 4, kSigned},
    {VK_FORMAT_R16G16B16_SNORM, 6, kSigned},
    {VK_FORMAT_R16G16B16A16_SNORM, 8, kSigned},
    {VK_FORMAT_A2B10G10R10_SNORM_PACK32, 4, kSigned},
    {VK_FORMAT_R8G8B8A8_UNORM, 4, kUnsigned},
    {VK_FORMAT_B8G8R8A8_UNORM, 4, kUnsigned},
    {VK_FORMAT_A8B8G8R8_UNORM_PACK32, 4, kUnsigned},
    {VK_FORMAT_A2B10G10R10_UNORM_PACK32, 4, kUnsigned},
    {VK_FORMAT_A2R10G10B10_UNORM_PACK32, 4, kUnsigned},
    {VK_FORMAT_R16G16B16_UNORM, 6, kUnsigned},
    {VK_FORMAT_R16G16B16A16_UNORM, 8, kUnsigned},
    {VK_FORMAT_B10G11R11_UFLOAT_PACK32, 4, kUnsigned},
    {VK_FORMAT_R16G16B16_SFLOAT, 6, kNormals},
    {VK_FORMAT_R32G32B32_SFLOAT, 12, kNormals},
    {VK_FORMAT_R16G16B16A16_SFLOAT, 8, kNormals | kTwo},
    {VK_FORMAT_R32G32B32A32_SFLOAT, 16, kNormals | kTwo},
    {VK_FORMAT_R16G16_SFLOAT, 4, kTwo},
    {VK_FORMAT_R32G32_SFLOAT, 8, kTwo},
    {VK_FORMAT_R16G16_SNORM, 4, kMotion},
};

const Known* find(VkFormat format) {
    for (const Known& known : kKnown)
        if (known.format == format) return &known;
    return nullptr;
}

}  // namespace

bool fits(Role role, VkFormat format) {
    const Known* known = find(format);
    return known && (known->roles & bit(role));
}

const char* formatsOf(Role role) {
    switch (role) {
        case Role::deviceDepth: return "D16, D24, D32 or R32F";
        case Role::linearDepth: return "R32F";
        case Role::signedNormals: return "three or four components, float or snorm";
        case Role::unsignedNormals: return "three or four components, unorm or float";
        case Role::packedNormals: return "R32_UINT";
        case Role::motion: return "two or four components, float or RG16 snorm";
        case Role::thickness: return "R32F or R16F";
        case Role::second: break;
    }
    return "RG32F or RG16F";
}

uint32_t leastBytes(VkFormat format) {
    const Known* known = find(format);
    return known ? known->bytes : 0;
}

}  // namespace obscura::ao
