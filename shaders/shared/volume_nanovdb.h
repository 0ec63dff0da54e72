// Lookups of shared/volume.h in a NanoVDB grid of type mask instead of the dense window, for shaders that define VOLUME_NANOVDB. PNanoVDB
// does the traversal; its accessor caches the nodes of the last lookup, so neighbouring cells are cheap.
#ifndef OBSCURA_SHARED_VOLUME_NANOVDB_H
#define OBSCURA_SHARED_VOLUME_NANOVDB_H

layout(set = 0, binding = VOLUME_BINDING, std430) readonly buffer VolumeBits { uint pnanovdb_buf_data[]; };
#define PNANOVDB_GLSL
#include <nanovdb/PNanoVDB.h>

pnanovdb_buf_t volumeBuffer;
pnanovdb_readaccessor_t volumeAccessor;

void openVolume() {
    volumeBuffer.unused = 0u;
    pnanovdb_grid_handle_t grid;
    grid.address = pnanovdb_address_null();
    pnanovdb_tree_handle_t tree = pnanovdb_grid_get_tree(volumeBuffer, grid);
    pnanovdb_readaccessor_init(volumeAccessor, pnanovdb_tree_get_root(volumeBuffer, tree));
}

ivec3 volumeCell(Volume v, vec3 place) { return ivec3(floor(place)) + ivec3(v.shift.xyz); }
bool occupied(Volume v, vec3 place) {
    return pnanovdb_readaccessor_is_active(PNANOVDB_GRID_TYPE_MASK, volumeBuffer, volumeAccessor, volumeCell(v, place));
}
float emptySide(Volume v, vec3 place) {
    if (occupied(v, place)) return 0.0;
    return float(pnanovdb_readaccessor_get_dim(PNANOVDB_GRID_TYPE_MASK, volumeBuffer, volumeAccessor, volumeCell(v, place)));
}
vec3 cubeBegin(Volume v, vec3 place, float side) {
    ivec3 corner = ivec3(v.shift.xyz);
    return vec3(((ivec3(floor(place)) + corner) & ~(ivec3(side) - 1)) - corner);
}
void volumeBox(Volume v, out vec3 low, out vec3 high) {
    pnanovdb_root_handle_t root = volumeAccessor.root;
    ivec3 corner = ivec3(v.shift.xyz);
    low = vec3(pnanovdb_root_get_bbox_min(volumeBuffer, root) - corner);
    high = vec3(pnanovdb_root_get_bbox_max(volumeBuffer, root) - corner + 1);
}

#endif
