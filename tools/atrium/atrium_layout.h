// Dimensions and material slots of the atrium.
#pragma once

#include <cstdint>

namespace obscura::atrium {

/// Material slots shared by every part of the atrium.
enum Slot : std::uint32_t { kStone, kPlaster, kTiles, kDarkStone, kWood, kIron, kTerracotta, kSoil, kLeaf, kCloth, kGlow, kSlotCount };

// The plan: a court of whole bays, a walk all round it, then the outer wall.
inline constexpr float kBay = 2.5f;
inline constexpr int kBaysLong = 8;
inline constexpr int kBaysShort = 3;
inline constexpr float kCourtX = 0.5f * kBay * kBaysLong;
inline constexpr float kCourtZ = 0.5f * kBay * kBaysShort;
inline constexpr float kWalk = 2.9f;
inline constexpr float kOuterX = kCourtX + kWalk;
inline constexpr float kOuterZ = kCourtZ + kWalk;
inline constexpr float kWallThickness = 0.5f;

// The elevation, the same for both storeys but for the height of the columns.
inline constexpr float kStoreyHeight = 5.0f;
inline constexpr float kLowerColumn = 3.0f;
inline constexpr float kUpperColumn = 2.75f;
inline constexpr float kArchHeight = 1.45f;
inline constexpr float kArchRadius = 0.93f;
inline constexpr float kArchDepth = 0.5f;
inline constexpr float kRoofTop = 10.0f;

}  // namespace obscura::atrium
