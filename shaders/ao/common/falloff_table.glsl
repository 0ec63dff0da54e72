// Size and layout of the falloff's table (falloff_table.comp): phi / pi over columns, b / (b + unit) over rows, both from edge to edge.
#ifndef OBSCURA_FALLOFF_TABLE_GLSL
#define OBSCURA_FALLOFF_TABLE_GLSL
#include "ao/common/arcs.glsl"
const uint kTableColumns = 64u, kTableRows = 128u;
#endif
