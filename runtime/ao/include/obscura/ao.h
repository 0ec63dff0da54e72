// Obscura: ambient-obscurance methods for Vulkan 1.3. The one public header; it needs the Vulkan headers and C++17.
//
//   create() adopts your device. record() writes commands into your command buffer: depth and normals in, visibility out.
//
// Contract. Nothing is submitted and nothing is waited for. After the first frames at a size, or below one Frame::maxSize, no device memory
// is allocated and no Vulkan object is made; descriptor sets come from existing pools. Recording uses the heap. Call record() outside
// rendering. It overwrites the pipeline, descriptor sets and push constants of the compute bind point, and no other command state. It puts
// the barriers that its own reads need: inputs are read in compute shaders after all earlier commands, and are left in the layouts that you
// name. No exception leaves the API; a failure is a Result and one line in your log. One thread uses a Context at a time. Contexts are
// independent: there is no global state. Strings, lists and descriptions are read during the call; handles stay yours.
//
// Space. Eye space is right-handed: camera at the origin, looking down -z, y up. Lengths are metres, or your unit if the falloff uses it
// too. Pixels count from the upper left. Matrices are stored by columns. Visibility is linear: 1 is open, 0 is blocked. A left-handed
// engine (camera looking down +z) negates the third column of Frame::projection and of Volume::cellFromEye, the third row of
// Frame::eyeFromWorld, and z of normals in eye space.
#ifndef OBSCURA_AO_H
#define OBSCURA_AO_H

#include <vulkan/vulkan_core.h>
#include <cstddef>
#include <cstdint>

#define OBSCURA_VERSION_MAJOR 0
#define OBSCURA_VERSION_MINOR 1
#define OBSCURA_VERSION_PATCH 0

// Marks the functions that a shared library exports. Only the library's own build defines OBSCURA_EXPORTS; a host defines nothing.
#if !defined(OBSCURA_EXPORTS)
#define OBSCURA_API
#elif defined(_WIN32)
#define OBSCURA_API __declspec(dllexport)
#else
#define OBSCURA_API __attribute__((visibility("default")))
#endif

namespace obscura::ao {

// What became of a call; a log line says why it failed.
enum class Result : uint8_t {
    ok,           // done
    invalid,      // an argument breaks this header's contract
    unsupported,  // the device cannot do it
    outOfMemory,  // host or device memory
    deviceLost,   // VK_ERROR_DEVICE_LOST
    shaderError,  // a pipeline cannot be made
};

// A view of `count` items, owned by whoever made it.
template <class T> struct List {
    const T* items = nullptr;                                 // the first
    size_t count = 0;                                         // how many
    const T* begin() const { return items; }                  // the first, for range-based loops
    const T* end() const { return items + count; }            // behind the last
    size_t size() const { return count; }                     // how many
    const T& operator[](size_t i) const { return items[i]; }  // i below count
};

// ---- Methods, parameters, presets -----------------------------------------------------------------------------------

// A parameter of a method.
struct Parameter {
    const char* id;             // "directions"
    const char* unit;           // "m", "px"; "" for counts and ratios
    float minimum;              // in `unit`, included
    float maximum;              // in `unit`, included
    float initial;              // in `unit`
    bool integer;               // whole numbers only
    List<const char*> choices;  // names of the values 0..count-1; empty for plain numbers
    const char* sentence;       // what it does, what it costs, what fails first when it is too low
};

// A value of a parameter.
struct Setting {
    const char* id;  // of a Parameter
    float value;     // in the parameter's unit; a choice by its number
};

// Settings of a method under a name.
struct Preset {
    const char* id;          // "default" is the first of every method
    const char* sentence;    // what it is good for
    List<Setting> settings;  // replace the parameters' initial values
};

// Inputs of a method, as bits.
enum Needs : uint32_t {
    kDepth = 1,    // Frame::depth
    kNormals = 2,  // Frame::normals
    kMotion = 4,   // Frame::motion
    kLayers = 8,   // Frame::layers
    kVolume = 16,  // Frame::volume
};

// A method: what it is, what it reads and what can be set.
struct MethodInfo {
    const char* id;              // "hbao"
    const char* title;           // "Horizon-based ambient occlusion"
    const char* paper;           // citation; empty for our own
    const char* sentence;        // how it works
    uint32_t needs;              // inputs it reads, as Needs. Without normals in a Frame they are reconstructed from depth
    List<Parameter> parameters;  // its own, then those that all methods share
    List<Preset> presets;        // the first is "default"
    bool baseline = false;       // a published method to compare with
    bool bentNormals = false;    // gives bent normals: MethodSettings::bentNormals
};

// All methods, in the order of keys and menus. Static storage.
OBSCURA_API List<const MethodInfo*> methods();
OBSCURA_API const MethodInfo* findMethod(const char* id);  // by its id; null if there is none

// How a method's noise is removed: "raw" (not at all), "spatial" (its own blur), "temporal" (its blur and reprojected history). Each is a
// few settings that replace the preset's; a method takes those that it has parameters for. Unrelated to multisample resolves. Static
// storage.
OBSCURA_API List<Preset> resolvePresets();
OBSCURA_API const Preset* findResolvePreset(const char* id);  // by its id; null if there is none

// ---- Falloff: how much an occluder counts by its distance -----------------------------------------------------------

// The curve, with x = distance / length.
enum class FalloffKind : uint32_t {
    exponential,  // exp(-x)
    linear,       // 1 - x, 0 from length on
    quadratic,    // 1 - x^2, 0 from length on
    wendland,     // (1 - x)^4 (4 x + 1), 0 from length on
    constant,     // 1 up to length, 0 beyond
    ramp,         // 1 up to length, linear to 0 at `end`
};

// How much an occluder counts at its distance: a curve and its lengths.
struct Falloff {
    FalloffKind kind = FalloffKind::quadratic;  // the curve
    float length = 2.0f;                        // metres, above 0
    float end = 0.0f;                           // metres, above length; ramp only
};
// "quadratic:2", "exponential:0.5", "ramp:0.385:1". False if malformed or if a length is not positive.
OBSCURA_API bool parseFalloff(const char* text, Falloff& out);
// The same as text, so that parseFalloff() gives the same falloff: at most `size` bytes with the final zero. Returns the text's length.
OBSCURA_API size_t formatFalloff(const Falloff& falloff, char* text, size_t size);
OBSCURA_API List<const char*> falloffKinds();                        // names of FalloffKind's values, in their order
OBSCURA_API float evaluate(const Falloff& falloff, float distance);  // metres -> [0, 1]
OBSCURA_API float reach(const Falloff& falloff);                     // metres from where it counts as 0 (exponential: where 1/256 is left)

// ---- Context --------------------------------------------------------------------------------------------------------

// The level of a log line.
enum class Severity : uint8_t {
    info,     // what was done
    warning,  // it works, but not as asked
    error,    // a call failed
};

// The format of the image that record() returns.
enum class VisibilityFormat : uint8_t {
    r16f,  // VK_FORMAT_R16_SFLOAT
    r8,    // VK_FORMAT_R8_UNORM, rounded to the nearest of 256 values
};

// A block of one of your memory pools.
struct MemoryBlock {
    VkDeviceMemory memory = VK_NULL_HANDLE;  // yours
    uint64_t offset = 0;                     // bytes, a multiple of the requested alignment
    void* mapped = nullptr;                  // if requested: address of the block's first byte, valid until free()
    void* token = nullptr;                   // yours; passed back to free()
};

// Device memory from your own pools. The callbacks are called from create(), setMethod(), record() and destroy(), on their thread, and must
// not throw. Set both or neither.
struct MemoryCallbacks {
    // Fills `block` with needs.size bytes of any type in needs.memoryTypeBits (if `mapped`, that mask holds host-coherent types only).
    // `image`: for an image of optimal tiling, else for a buffer; bufferImageGranularity is yours to keep. Returns VK_SUCCESS or an error.
    VkResult (*allocate)(void* user, const VkMemoryRequirements& needs, bool mapped, bool image, MemoryBlock& block) = nullptr;
    void (*free)(void* user, const MemoryBlock& block) = nullptr;  // the GPU no longer uses it
    void* user = nullptr;                                          // passed to both
};

// Your device. All handles are yours and stay valid until destroy().
struct DeviceDesc {
    VkInstance instance = VK_NULL_HANDLE;              // Vulkan 1.3
    VkPhysicalDevice physicalDevice = VK_NULL_HANDLE;  // of `device`
    VkDevice device = VK_NULL_HANDLE;  // with the features synchronization2, maintenance4 and shaderStorageImageExtendedFormats enabled
    uint32_t queueFamily = 0;          // of the command buffers given to record(); supports compute
    PFN_vkGetInstanceProcAddr getInstanceProcAddr = nullptr;  // the loader's; the library does not link it
    uint32_t framesInFlight = 2;  // N >= 1: when record() is called, the GPU has finished the frame N frames ago
    uint32_t views = 1;  // 1 to 16: the most calls of record() in a frame, one for each view: eyes, or players of a split screen. Each view
                         // costs as much time as a frame of its own, and its history as much memory; the rest is shared
    VisibilityFormat format = VisibilityFormat::r16f;  // of Output::image
    VkPipelineCache pipelineCache = VK_NULL_HANDLE;    // yours, for the library's pipelines; null: one of its own, in memory
    // Host memory of Vulkan objects; null: the driver's. Must outlive the context. The library's own containers use operator new.
    const VkAllocationCallbacks* allocator = nullptr;
    MemoryCallbacks memory;  // device memory; empty: vkAllocateMemory, one allocation for each image and buffer (a few for a method)
    void (*log)(void* user, Severity severity, const char* line) = nullptr;  // null: warnings and errors go to stderr
    void* logUser = nullptr;                                                 // passed to log()
};

// Whether create() can adopt a device that vkCreateDevice() makes with `info`: its features, as pEnabledFeatures or in the chain, and
// what the physical device supports. One log line for each thing that is missing says what to do. Of `desc`, `device` may be null.
OBSCURA_API Result checkDevice(const DeviceDesc& desc, const VkDeviceCreateInfo& info) noexcept;

// A device and the method set on it; opaque.
struct Context;
OBSCURA_API Result create(const DeviceDesc& desc, Context** context) noexcept;  // sets the method `hbao`; *context is null unless ok
OBSCURA_API void destroy(Context* context) noexcept;  // before the device, after the GPU has finished its frames; null is ignored

// What setMethod() sets.
struct MethodSettings {
    const char* preset = "default";  // of the method
    List<Setting> settings;          // replace those of preset and resolve
    Falloff falloff;                 // by which every method counts occluders
    const char* resolve = nullptr;   // of resolvePresets(), replaces settings of the preset; null: as the preset says
    bool bentNormals = false;        // record() also gives Output::bentNormals; for methods with MethodInfo::bentNormals
};
// Selects the method of the next record() and makes its pipelines. Unknown ids are Result::invalid, with a log line that lists the known
// ones; values out of range are clamped. On failure the method set before stays.
OBSCURA_API Result setMethod(Context* context, const char* id, const MethodSettings& settings) noexcept;

// ---- Frames ---------------------------------------------------------------------------------------------------------

// An input image.
struct ImageView {
    VkImage image = VK_NULL_HANDLE;                         // yours; valid until the GPU has finished the frame
    VkImageView view = VK_NULL_HANDLE;                      // 2D, one mip and layer; of depth formats the depth aspect only
    VkFormat format = VK_FORMAT_UNDEFINED;                  // of the view
    VkImageLayout layout = VK_IMAGE_LAYOUT_UNDEFINED;       // of that mip and layer, on entry and on return; not UNDEFINED
    uint32_t mip = 0;                                       // of `image`, which the view shows
    uint32_t layer = 0;                                     // of `image`, which the view shows
    VkSampleCountFlagBits samples = VK_SAMPLE_COUNT_1_BIT;  // of `image`; above 1, sample 0 of each pixel is copied and read
};

// What a depth image holds.
enum class DepthKind : uint8_t {
    device,  // the value in the depth buffer
    linear,  // distance along the view axis, -z, metres
};

// The space of normals.
enum class NormalKind : uint8_t {
    eye,    // as at the head of this file
    world,  // that of Frame::eyeFromWorld
};

// How a texel holds a normal.
enum class NormalEncoding : uint8_t {
    signedFloat,   // xyz
    biased,        // xyz * 0.5 + 0.5
    octahedral32,  // two snorm16 of an octahedral map, in one uint
};

// How a buffer holds the cells of a Volume. Cell (x, y, z) counts from a fixed point of the world.
enum class VolumeStructure : uint8_t {
    // A cube of cells, anchored in the world. The buffer holds the cells from `origin` on, each at its coordinates modulo `cells`, so that
    // moving the cube rewrites only the cells that enter. A brick has 8 cells a side and 16 words: a cell is bit 8 (y & 3) + (z & 7) of
    // word 2 (x & 7) + ((y & 7) >> 2). Brick (X, Y, Z) = (x, y, z) / 8 modulo s begins at word 16 ((X s + Y) s + Z), with s = cells / 8.
    // More levels follow as cubes of as many cells, those of level k 2^k times as wide: cell c of level k covers the cells 2^k c to
    // 2^k (c + 1) - 1 of level 0 on each axis and is set if one of them is. Level k holds, modulo `cells`, all its cells less than
    // cells / 2 - 8 of them from the middle of level 0.
    dense,
    // A NanoVDB grid of type mask. With `cells` 0: its index space counts the cells of the one level, and it has no edge. Else it holds
    // cell (x, y, z) of level k at ((x modulo cells) + k cells, y modulo cells, z modulo cells).
    nanovdb,
};

// The world as bits, 1 where a cell touches surface (conservative: every cell that a triangle touches), for methods with kVolume.
struct Volume {
    VolumeStructure structure = VolumeStructure::dense;  // of `buffer`
    VkBuffer buffer = VK_NULL_HANDLE;                    // storage usage; null: no volume
    uint64_t offset = 0;                                 // bytes, a multiple of minStorageBufferOffsetAlignment
    uint64_t bytes = 0;                                  // nanovdb: of the grid. dense: levels cells^3 / 8 are read
    uint32_t cells = 0;                                  // a side of each level, a power of two from 8 to 1024; nanovdb: or 0, see there
    uint32_t levels = 1;                                 // 1 to 8; more than one need 32 cells or more, and the camera near the middle
    int32_t origin[3] = {};                              // the lowest cell of level 0. nanovdb with cells 0: any cell near the camera
    float cellFromEye[16] = {};  // eye space -> cells of level 0, counted from the lowest corner of `origin`; rotation, translation,
                                 // uniform scale
};

// What lies behind the visible surface along each pixel's view ray, for methods with the parameter `depth_layers`, which says how much of
// it they read. Both images are optional; `second` needs `thickness`. Linear depths, metres; sampled usage.
struct DepthLayers {
    // Frame::size, one float (R16F is enough): distance along the view axis from the visible surface to the end of the solid behind it.
    // 0: an open sheet, which gets the method's own thickness. 65504: endless.
    ImageView thickness;
    ImageView second;         // two floats (RG32F, RG16F): depth of the next surface behind that solid, 0 for none, and its thickness
    VkExtent2D secondSize{};  // Frame::size, or half of it rounded up: then texel p belongs to pixel 2 p
};

// What record() reads. Images may be larger than `size`: the part of them that begins at `origin` is read, and nothing outside it.
struct Frame {
    VkExtent2D size{};          // px, of depth and normals, guard band included
    VkExtent2D maxSize{};       // px; 0: none. For dynamic resolution: the largest `size` to come, for which memory is made. While it is
                                // the same, frames of any size up to it allocate nothing and keep the history
    VkExtent2D guard{};         // px on each side that are read but not shown: visible = size - 2 guard. Multiples of 16 are fastest
    VkOffset2D origin{};        // px, where that part begins in every image, as a player's in a split screen. Not 0: the part is copied
                                // first. layers.second of half size begins at half of it, so it must be even then
    float projection[16] = {};  // eye -> clip space of that part. The depth convention is read from it: perspective or orthographic,
                                // reversed or not, finite or infinite, off-centre, y up or down
    float eyeFromWorld[16] = {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1};  // rigid; used by world normals and by history
    ImageView depth;                          // device: D16, D24, D32 or R32F; linear: R32F. Sampled usage
    DepthKind depthKind = DepthKind::device;  // what `depth` holds
    // Optional geometric normals, of any length but 0, sampled usage. Smooth or normal-mapped ones make `layered` spotty, since it compares
    // them with the depth buffer: leave them out there.
    ImageView normals;
    NormalKind normalKind = NormalKind::eye;                      // the space of `normals`
    NormalEncoding normalEncoding = NormalEncoding::signedFloat;  // how a texel of `normals` holds a vector
    // Optional, for the parameter `temporal`: two floats, sampled usage; where each pixel's surface was last frame. Without it history
    // follows the camera, by eyeFromWorld and projection of both frames: surfaces that move by themselves begin anew.
    ImageView motion;
    float motionScale[2] = {1, 1};  // motion * motionScale = px from this pixel to last frame's position, y down. Motion in UV:
                                    // {width, height}; in NDC with y up: {width / 2, -height / 2}; pointing from last frame to this:
                                    // negated. If `size` has changed, px of this frame: last frame's picture is stretched to this one's
    // px, x right, y down: how far the jitter of temporal anti-aliasing in `projection` moves the image this frame, if `motion` leaves it
    // out. 0: there is no jitter, or `motion` contains it, or there is no `motion`.
    float jitter[2] = {0, 0};
    bool cut = false;       // camera cut: history is discarded this frame
    DepthLayers layers;     // optional
    Volume volume;          // optional
    float skyDepth = 0.0f;  // metres: depths from here on are sky; 0: the far plane of `projection`
    uint64_t index = 0;     // frame number: with `temporal`, selects this frame's rotation of the samples. Add 1 each frame, not each view
    uint32_t view = 0;      // which view this is, below DeviceDesc::views: each has its own history and `cut`
};

// What record() gives. The images are the context's. They keep their contents until framesInFlight more frames have been recorded; you may
// leave them in any layout.
//
// A bent normal is the mean direction of unblocked light [Landis 2002]: with V visibility in the direction w, the integral of
// V(w) (n.w) w dw over the hemisphere around the normal n, normalised. Occluders count by the falloff, as for visibility. Where nothing
// is visible it is the normal. It is averaged over neighbours on the same surface, but not over frames, and leaves out the occluders of
// the parameter `offscreen`.
struct Output {
    Result status = Result::invalid;    // not ok: nothing was recorded, the handles are null, a log line says why
                                        // (outOfMemory: some commands may have been recorded; discard the command buffer)
    VkImage image = VK_NULL_HANDLE;     // DeviceDesc::format, `size` or, with Frame::maxSize, larger; usage sampled, transfer both ways
    VkImageView view = VK_NULL_HANDLE;  // 2D, one mip
    VkImageLayout layout = VK_IMAGE_LAYOUT_UNDEFINED;  // SHADER_READ_ONLY_OPTIMAL; reads in any shader stage need no barrier
    VkExtent2D size{};  // px: the visible size. The result is that part of the image, from its upper left pixel on
    // With MethodSettings::bentNormals, else null: xyz the bent normal, eye space, unit length, 0 for sky; w visibility, 1 for sky.
    // R8G8B8A8_SNORM; usage, layout and valid part as of `image`.
    VkImage bentNormals = VK_NULL_HANDLE;
    VkImageView bentNormalsView = VK_NULL_HANDLE;  // 2D, one mip
};
// Records the method's passes; the contract stands at the head of this file.
OBSCURA_API Output record(Context* context, VkCommandBuffer cmd, const Frame& frame) noexcept;

OBSCURA_API uint64_t memoryUse(const Context* context) noexcept;  // bytes of device memory held
// Bytes of device memory that the context will hold once it records frames like this one with the method now set. Of the frame's images
// only size and format are read: handles and layouts may be null. Allocates no device memory. 0, and a log line, where record() would
// refuse.
OBSCURA_API uint64_t memoryUse(Context* context, const Frame& frame) noexcept;
// Gives back what frames like the last one do not need: memory of larger sizes, and pipelines of methods other than the one now set. It is
// freed in the next calls of record(), once the GPU has finished the frames that use it, or in destroy().
OBSCURA_API void trim(Context* context) noexcept;

// The GPU time of one pass of record().
struct PassTime {
    const char* name;     // "hbao.horizons"
    double milliseconds;  // on the GPU
};
// Of the newest record() that the GPU has finished. Owned by the context, valid until the next record().
OBSCURA_API List<PassTime> timings(Context* context) noexcept;

}  // namespace obscura::ao

#endif
