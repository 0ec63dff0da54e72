// Obscura: ambient-obscurance methods for Vulkan 1.3. The one public header: needs only the Vulkan headers, C++17.
//
//   create() adopts your device; record() writes commands into your command buffer: depth and normals in, visibility out.
//
// Contract. Nothing is submitted or waited for. After the first frames at a size no device memory is allocated and no Vulkan
// object made, descriptor sets out of pools that are there aside; recording itself works in the heap. Call record() outside
// rendering; the compute bind point's pipeline, descriptor sets and push constants are clobbered, nothing else is. Inputs are
// read in shaders and come back in the layouts you name. No exception leaves; every failure is a Status and one line to your
// log. A Context is used by one thread at a time; different contexts are independent: there is no global state. Strings, lists
// and descriptions that you pass are read during the call and may go after it; handles stay yours.
//
// Space. Eye space: right-handed, camera at the origin looking down -z, y up; lengths in metres (or your unit: the falloff
// has the same). Pixels count from the upper left. Visibility: 1 open, 0 blocked, linear.
#ifndef OBSCURA_AO_H
#define OBSCURA_AO_H

#include <cstddef>
#include <cstdint>
#include <vulkan/vulkan_core.h>

// Marks the functions that a shared library exports. Only the library's own build defines OBSCURA_EXPORTS; a host defines nothing.
#if !defined(OBSCURA_EXPORTS)
#define OBSCURA_API
#elif defined(_WIN32)
#define OBSCURA_API __declspec(dllexport)
#else
#define OBSCURA_API __attribute__((visibility("default")))
#endif

namespace obscura::ao {

enum class Status : uint8_t { ok, invalid, unsupported, outOfMemory, deviceLost, shaderError };

template <class T> struct List {  // a view of `count` items; owned by whoever made it
    const T* items = nullptr;
    size_t count = 0;
    const T* begin() const { return items; }
    const T* end() const { return items + count; }
    size_t size() const { return count; }
    const T& operator[](size_t i) const { return items[i]; }
};

// ---- What there is to choose ----------------------------------------------------------------------------------------

struct Parameter {
    const char* id;        // "directions"
    const char* unit;      // "m", "px", "" for counts
    float minimum, maximum, initial;  // in `unit`; both ends included
    bool integer;          // whole numbers only
    List<const char*> choices;  // named values 0..count-1; empty for plain numbers
    const char* sentence;  // what it does and what it costs
};

struct Setting {
    const char* id;        // of a Parameter
    float value;           // in the parameter's unit; a choice by its number
};

struct Preset {
    const char* id;        // "default" comes first in every method
    const char* sentence;  // what it is good for
    List<Setting> settings;  // over the initial values
};

enum Needs : uint32_t { kDepth = 1, kNormals = 2, kMotion = 4, kLayers = 8, kVolume = 16 };

struct MethodInfo {
    const char* id;        // "hbao"
    const char* title;     // "Horizon-based ambient occlusion"
    const char* paper;     // citation; empty for our own
    const char* sentence;  // how it works
    uint32_t needs;        // Needs it cannot do without (missing normals are reconstructed)
    List<Parameter> parameters;  // its own, then those that all share
    List<Preset> presets;  // the first is "default"
    bool yardstick = false;  // here to be compared with; others' published method, not one this library is about
};

// All methods, in the order keys and menus show them. Static storage.
OBSCURA_API List<const MethodInfo*> methods();
OBSCURA_API const MethodInfo* findMethod(const char* id);  // null when there is none

// What becomes of any method's samples before they are shown: "raw", as they are; "spatial", its own blur; "temporal", that and the shared
// history. A few settings over a preset each; a method goes by those that it has parameters for. Static storage.
OBSCURA_API List<Preset> resolvePresets();
OBSCURA_API const Preset* findResolvePreset(const char* id);  // null when there is none

// ---- How far occluders reach ----------------------------------------------------------------------------------------

enum class FalloffKind : uint32_t { exponential, linear, quadratic, wendland, constant, ramp };

struct Falloff {
    FalloffKind kind = FalloffKind::quadratic;  // the curve
    float length = 2.0f;   // metres: exp(-d/length); 1-d/length; 1-(d/length)^2; ...; ramp: 1 up to here
    float end = 0.0f;      // metres, ramp only: 0 from here on
};
// "quadratic:2", "exponential:0.5", "ramp:0.385:1". False when malformed or a length is not positive.
OBSCURA_API bool parseFalloff(const char* text, Falloff& out);
OBSCURA_API float evaluate(const Falloff& falloff, float distance);  // metres -> [0,1]
OBSCURA_API float reach(const Falloff& falloff);                     // metres beyond which it counts as 0 (exponential: 1/256 is left)

// ---- The door for host engines --------------------------------------------------------------------------------------

enum class Severity : uint8_t { info, warning, error };
enum class VisibilityFormat : uint8_t { r16f, r8 };  // VK_FORMAT_R16_SFLOAT; VK_FORMAT_R8_UNORM, rounded to the nearest of 256 values

// Device memory out of your own pools. Called from create(), setMethod(), record() and destroy(), on their thread; throws nothing.
struct MemoryBlock {
    VkDeviceMemory memory = VK_NULL_HANDLE;  // yours
    uint64_t offset = 0;      // bytes, a multiple of the alignment asked for
    void* mapped = nullptr;   // where asked for: address of the block's first byte, good until free()
    void* token = nullptr;    // yours, comes back to free()
};
struct MemoryCallbacks {      // both functions or neither
    // needs.size bytes of a type in needs.memoryTypeBits: any of them will do (what is to be mapped gets coherent ones alone). `image`: for an
    // image of optimal tiling, else for a buffer; bufferImageGranularity is yours to keep. Not VK_SUCCESS: there is none.
    VkResult (*allocate)(void* user, const VkMemoryRequirements& needs, bool mapped, bool image, MemoryBlock& block) = nullptr;  // fills `block`
    void (*free)(void* user, const MemoryBlock& block) = nullptr;  // the GPU is done with it
    void* user = nullptr;     // comes back to both
};

struct DeviceDesc {
    VkInstance instance = VK_NULL_HANDLE;              // Vulkan 1.3, as all handles here yours and alive until destroy()
    VkPhysicalDevice physicalDevice = VK_NULL_HANDLE;  // that `device` was made of
    VkDevice device = VK_NULL_HANDLE;    // Vulkan 1.3 with the features synchronization2, maintenance4 and shaderStorageImageExtendedFormats on
    uint32_t queueFamily = 0;            // of the command buffers given to record(); must do compute
    PFN_vkGetInstanceProcAddr getInstanceProcAddr = nullptr;  // the loader's; the library links to none
    uint32_t framesInFlight = 2;         // 1 or more: record() reuses what it used so many calls ago; the GPU is done with that by then
    VisibilityFormat format = VisibilityFormat::r16f;  // of every Output
    const VkAllocationCallbacks* allocator = nullptr;  // host memory of Vulkan objects; null: the driver's. Must outlive the context.
                                         // The library's own lists and texts come from operator new, which may throw: that is a Status
    MemoryCallbacks memory;              // device memory; empty: vkAllocateMemory, a handful of images and buffers a method
    void (*log)(void* user, Severity severity, const char* line) = nullptr;  // null: warnings and errors go to stderr
    void* logUser = nullptr;             // comes back to log()
};

struct Context;                          // opaque; destroy() before the device
OBSCURA_API Status create(const DeviceDesc& desc, Context** context) noexcept;  // sets the method `hbao`; *context is null unless ok
OBSCURA_API void destroy(Context* context) noexcept; // the caller has waited for the GPU; null is ignored

// Which method the next record() runs. Unknown ids and settings are Status::invalid with a log line that lists what there
// is; values out of range are clamped. Pipelines are made here, not in record().
struct MethodSettings {
    const char* preset = "default";      // of the method
    List<Setting> settings;              // over the preset, and over `resolve`
    Falloff falloff;                     // the same question to every method
    const char* resolve = nullptr;       // of resolvePresets(), over the preset; null: as that says
};
OBSCURA_API Status setMethod(Context* context, const char* id, const MethodSettings& settings) noexcept;

struct ImageView {
    VkImage image = VK_NULL_HANDLE;      // yours, until the GPU is done with the frame
    VkImageView view = VK_NULL_HANDLE;   // 2D, mip 0; depth formats: depth aspect only
    VkFormat format = VK_FORMAT_UNDEFINED;  // of the view
    VkImageLayout layout = VK_IMAGE_LAYOUT_UNDEFINED;  // on entry and on return; contents must stay
};

enum class DepthKind : uint8_t { device, linear };          // linear: -z in metres
enum class NormalKind : uint8_t { eye, world };
enum class NormalEncoding : uint8_t { signedFloat, unsignedHalf, octahedral32 };  // xyz; xyz*0.5+0.5; uint, two snorm16

// A cube of the world as bits, 1 where there is surface, for the methods that need kVolume. World-anchored: cell (x, y, z) counts
// from a fixed point, and the buffer holds the cells from `origin` on, each at its place modulo the side, so that moving the cube
// rewrites only what entered. A brick is 8 cells a side, 16 words: cell -> bit 8 (y & 3) + (z & 7) of word
// 2 (x & 7) + ((y & 7) >> 2); brick (X, Y, Z) = (x, y, z) / 8 modulo s -> words 16 ((X s + Y) s + Z) on, s = cells / 8.
// Conservative bits are expected: every cell that a triangle touches.
// Or, for a world that no cube covers, a NanoVDB grid of type mask whose index space counts cells likewise.
enum class VolumeStructure : uint8_t { dense, nanovdb };
struct Volume {
    VolumeStructure structure = VolumeStructure::dense;  // which of the two
    VkBuffer buffer = VK_NULL_HANDLE;    // storage usage, cells^3 / 8 bytes (nanovdb: `bytes`) from `offset` on; null: no volume
    uint64_t offset = 0;                 // bytes, a multiple of minStorageBufferOffsetAlignment
    uint64_t bytes = 0;                  // nanovdb: of the grid
    uint32_t cells = 0;                  // dense: a side, a power of two, 8 to 1024
    int32_t origin[3] = {};              // lowest cell held; a cube that stays put may leave it 0. nanovdb: any cell near the eye
    float cellFromEye[16] = {};          // eye space -> cells from that cell's lowest corner, columns; turns, moves and scales evenly
};

// What lies behind the visible surface along each pixel's view ray, for the methods with a parameter `depth_layers`, which says how much
// of this they read. Bring what you have: both, the first image alone, or neither. Linear depths, metres.
struct DepthLayers {
    ImageView thickness;                 // `Frame::size`; one float (R16F will do), sampled usage: from the visible surface to where the
                                         // solid it belongs to ends. 0: an open sheet, as thick as the method thinks. 65504: endless
    ImageView second;                    // the next surface behind that: its depth, 0 where there is none, and its thickness, likewise;
    VkExtent2D secondSize{};             // two floats (RG32F, RG16F), sampled usage. Frame::size, or half of it rounded up: texel p is
};                                       // then that of pixel 2p

struct Frame {
    VkExtent2D size{};                   // of depth and normals, guard band included
    VkExtent2D guard{};                  // px on each side that are read but not shown; visible = size - 2 guard. Best multiples of 16
    float projection[16] = {};           // eye -> clip of the whole image, columns, Vulkan clip space; any depth convention
    float eyeFromWorld[16] = {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1};  // columns, rigid; for world normals and for histories
    ImageView depth;                     // device: D16, D24, D32 or R32F, sampled usage; linear: R32F
    DepthKind depthKind = DepthKind::device;  // device: as `projection` says
    ImageView normals;                   // optional: geometric normals, sampled usage
    NormalKind normalKind = NormalKind::eye;  // the space; world: turned by eyeFromWorld
    NormalEncoding normalEncoding = NormalEncoding::signedFloat;  // need not be of length one
    ImageView motion;                    // optional, for `temporal`: where each pixel's surface was, two floats, sampled usage, `size`
    float motionScale[2] = {1, 1};       // motion times this: px from here to last frame's position, y down. Motion in UV:
                                         // {width, height}; in NDC with y up: {width/2, -height/2}; from the past: negated
    bool cut = false;                    // first frame after a jump: last frame's picture is no past of this one
    DepthLayers layers;                  // optional
    Volume volume;                       // optional
    float skyDepth = 0.0f;               // linear depths from here on are sky; 0: what the projection's far plane says
    uint64_t index = 0;                  // counts frames
};

// Visibility. The image is the context's; it holds what it says until the context has recorded framesInFlight more frames, and you may leave it
// in any layout. All null unless status is ok. (A method that makes bent normals will say so in MethodInfo, and a second image of this kind will follow here.)
struct Output {
    Status status = Status::invalid;     // not ok: a line in the log says why, and nothing was recorded
                                         // (outOfMemory: some may have been; throw the command buffer away)
    VkImage image = VK_NULL_HANDLE;      // DeviceDesc::format, Frame::size less guard bands; usage sampled, transfer source and destination
    VkImageView view = VK_NULL_HANDLE;   // 2D, one mip
    VkImageLayout layout = VK_IMAGE_LAYOUT_UNDEFINED;  // SHADER_READ_ONLY_OPTIMAL: reads in compute and fragment shaders need no barrier
};
OBSCURA_API Output record(Context* context, VkCommandBuffer cmd, const Frame& frame) noexcept;

OBSCURA_API uint64_t memoryUse(const Context* context) noexcept;  // bytes of device memory held
// Before there is any: what a context comes to hold that records frames like this one with the method now set. Of the frame's images
// only size and format count, and one with a format counts as given. Allocates no device memory. 0, logged, where record() would refuse.
OBSCURA_API uint64_t memoryUse(Context* context, const Frame& frame) noexcept;

struct PassTime { const char* name; double milliseconds; };
OBSCURA_API List<PassTime> timings(Context* context) noexcept;  // of the newest finished frame; valid until the next record(), owned by the context

}  // namespace obscura::ao

#endif
