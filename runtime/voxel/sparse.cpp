#include "voxel/sparse.h"

#include <cstring>
#include <fstream>
#include <sstream>

#include <fmt/format.h>
#include <nanovdb/util/OpenToNanoVDB.h>
#include <openvdb/io/Stream.h>
#include <openvdb/openvdb.h>
#include <unistd.h>

#include "scene/gltf/gltf.h"
#include "scene/hash.h"

namespace obscura::voxel {
namespace {

constexpr const char* kGridName = "occupancy";
constexpr const char* kKeyName = "obscura.key";
constexpr std::string_view kSeal = "\nobscura ";  // followed by 32 hexadecimal digits: the trailing line of a file
constexpr size_t kSealBytes = kSeal.size() + 32;

std::string seal(std::string_view bytes) { return std::string(kSeal) + scene::Hash().add(bytes).hex(); }

openvdb::Coord firstCell(const glm::ivec3& place) { return {place.x * kBrickSide, place.y * kBrickSide, place.z * kBrickSide}; }

static_assert(sizeof(openvdb::MaskTree::LeafNodeType::NodeMaskType) == sizeof(Brick) && openvdb::MaskTree::LeafNodeType::LOG2DIM == 3);

}  // namespace

struct Sparse::Impl {
    openvdb::MaskGrid::Ptr grid = openvdb::MaskGrid::create();
    uint64_t cells = 0, bricks = 0;
    openvdb::MaskTree& tree() const { return grid->tree(); }
};

Sparse::Sparse() : m_impl(std::make_unique<Impl>()) {}
Sparse::~Sparse() = default;
Sparse::Sparse(Sparse&&) noexcept = default;
Sparse& Sparse::operator=(Sparse&&) noexcept = default;

void Sparse::add(const BrickSet& bricks) {
    openvdb::tree::ValueAccessor<openvdb::MaskTree> accessor(m_impl->tree());
    for (size_t i = 0; i < bricks.size(); ++i) {
        const openvdb::Coord at = firstCell(bricks.place(i));
        auto* leaf = accessor.probeLeaf(at);
        if (!leaf) {
            leaf = accessor.touchLeaf(at);
            ++m_impl->bricks;
        }
        Brick brick;
        std::memcpy(brick.words.data(), leaf->buffer().data(), sizeof(Brick));
        m_impl->cells -= brick.count();
        brick |= bricks[i];
        m_impl->cells += brick.count();
        std::memcpy(leaf->buffer().data(), brick.words.data(), sizeof(Brick));
    }
}

bool Sparse::find(const glm::ivec3& place, Brick& out) const {
    const auto* leaf = m_impl->tree().probeConstLeaf(firstCell(place));
    if (leaf) std::memcpy(out.words.data(), leaf->buffer().data(), sizeof(Brick));
    return leaf != nullptr;
}

bool Sparse::test(const glm::ivec3& cell) const { return m_impl->tree().isValueOn(openvdb::Coord(cell.x, cell.y, cell.z)); }

BrickSet Sparse::bricksOfAll() const {
    BrickSet result;
    for (auto leaf = m_impl->tree().cbeginLeaf(); leaf; ++leaf) {
        const openvdb::Coord at = leaf->origin();
        std::memcpy(result.at(brickOf({at.x(), at.y(), at.z()})).words.data(), leaf->buffer().data(), sizeof(Brick));
    }
    return result;
}

bool Sparse::put(const glm::ivec3& place, const Brick& brick) {
    const openvdb::Coord at = firstCell(place);
    auto* leaf = m_impl->tree().probeLeaf(at);
    Brick before;
    if (leaf) std::memcpy(before.words.data(), leaf->buffer().data(), sizeof(Brick));
    if (before == brick && !(leaf && brick.empty())) return false;
    m_impl->cells += uint64_t(brick.count()) - before.count();
    if (brick.empty()) {
        delete m_impl->tree().root().stealNode<openvdb::MaskTree::LeafNodeType>(at, false, false);
        --m_impl->bricks;
        return true;
    }
    if (!leaf) {
        leaf = m_impl->tree().touchLeaf(at);
        ++m_impl->bricks;
    }
    std::memcpy(leaf->buffer().data(), brick.words.data(), sizeof(Brick));
    return true;
}

std::vector<uint32_t> Sparse::nano() const {
    const auto handle = nanovdb::openToNanoVDB<nanovdb::HostBuffer, openvdb::MaskTree, nanovdb::ValueMask>(
        *m_impl->grid, nanovdb::StatsMode::BBox, nanovdb::ChecksumMode::Disable);
    std::vector<uint32_t> words((handle.size() + 3) / 4, 0);
    std::memcpy(words.data(), handle.data(), handle.size());
    return words;
}

uint64_t Sparse::cells() const { return m_impl->cells; }
uint64_t Sparse::bricks() const { return m_impl->bricks; }
uint64_t Sparse::bytes() const { return m_impl->tree().memUsage(); }

void Sparse::save(const std::filesystem::path& file, const std::string& key, double cellSize) const {
    const std::filesystem::path temporary = file.string() + fmt::format(".{}.tmp", ::getpid());
    try {
        openvdb::initialize();
        std::ostringstream text(std::ios::binary);
        const openvdb::MaskGrid::Ptr grid = m_impl->grid->copy();  // shares the tree
        grid->setName(kGridName);
        grid->setTransform(openvdb::math::Transform::createLinearTransform(cellSize));
        grid->insertMeta(kKeyName, openvdb::StringMetadata(key));
        openvdb::io::Stream(text).write(openvdb::GridCPtrVec{grid});
        const std::string bytes = std::move(text).str();
        std::ofstream out(temporary, std::ios::binary);
        out << bytes << seal(bytes);
        out.close();
        if (!out) throw scene::Error(fmt::format("{}: cannot be written", temporary.string()));
        std::filesystem::rename(temporary, file);
    } catch (const std::exception& error) {
        std::error_code ignored;
        std::filesystem::remove(temporary, ignored);
        throw scene::Error(fmt::format("{}: {}", file.string(), error.what()));
    }
}

Sparse Sparse::load(const std::filesystem::path& file, const std::string& key) {
    std::ifstream in(file, std::ios::binary);
    std::string bytes{std::istreambuf_iterator<char>(in), {}};
    const auto refuse = [&](const char* why) -> scene::Error { return scene::Error(file.string() + ": " + why); };
    if (bytes.size() < kSealBytes) throw refuse("is truncated");
    const std::string trailer = bytes.substr(bytes.size() - kSealBytes);
    bytes.resize(bytes.size() - kSealBytes);
    if (seal(bytes) != trailer) throw refuse("is damaged");
    Sparse result;
    try {
        openvdb::initialize();
        std::istringstream text(std::move(bytes), std::ios::binary);
        openvdb::io::Stream stream(text, /*delayLoad=*/false);
        const openvdb::GridPtrVecPtr grids = stream.getGrids();
        if (grids->size() != 1) throw refuse("must have one grid");
        const auto grid = openvdb::gridPtrCast<openvdb::MaskGrid>(grids->front());
        if (!grid) throw refuse("must have a mask grid");
        const auto stored = grid->getMetadata<openvdb::StringMetadata>(kKeyName);
        if (!stored || stored->value() != key) throw refuse("belongs to another world");
        result.m_impl->grid = grid;
        result.m_impl->cells = grid->tree().activeVoxelCount();
        result.m_impl->bricks = grid->tree().leafCount();
    } catch (const openvdb::Exception& error) {
        throw refuse(error.what());
    }
    return result;
}

}  // namespace obscura::voxel
