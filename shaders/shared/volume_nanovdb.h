// Lookups of shared/volume.h in a NanoVDB grid of type mask instead of dense cubes, for shaders that define VOLUME_NANOVDB. PNanoVDB does
// the traversal; its accessor caches the nodes of the last lookup, so neighbouring cells are cheap.
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

ivec3 gridCell(Volume v, vec3 place, uint level) {
    ivec3 cell = (ivec3(floor(place)) + (ivec3(v.anchor.xyz) >> level)) & (int(v.anchor.w) - 1);  // w = 0: all bits
    return ivec3(cell.x + int(level * v.anchor.w), cell.yz);
}
bool occupiedAt(Volume v, vec3 place, uint level) {
    return pnanovdb_readaccessor_is_active(PNANOVDB_GRID_TYPE_MASK, volumeBuffer, volumeAccessor, gridCell(v, place, level));
}
float emptySideAt(Volume v, vec3 place, uint level) {
    ivec3 cell = gridCell(v, place, level);
    if (pnanovdb_readaccessor_is_active(PNANOVDB_GRID_TYPE_MASK, volumeBuffer, volumeAccessor, cell)) return 0.0;
    uint side = pnanovdb_readaccessor_get_dim(PNANOVDB_GRID_TYPE_MASK, volumeBuffer, volumeAccessor, cell);
    return float(v.anchor.w == 0u ? side : min(side, 8u));  // larger cubes may wrap around the edge of a level
}

#endif
