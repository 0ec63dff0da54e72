// libFuzzer on cached voxels: any bytes give the grid that was saved, or one line. OpenVDB must not see a damaged file.
#include <iterator>

#include "target.h"
#include "voxel/sparse.h"

namespace {

std::vector<uint8_t> saved() {
    using namespace obscura;
    voxel::BrickSet bricks;
    for (int i = 0; i < 4; ++i) bricks.set({8 * i, 16 * i + 3, -8 * i});
    voxel::Sparse sparse;
    sparse.add(bricks);
    const std::filesystem::path file = fuzz::file("sample.vdb", {});
    sparse.save(file, "key", 0.1);
    std::ifstream in(file, std::ios::binary);
    return {std::istreambuf_iterator<char>(in), {}};
}
const std::vector<uint8_t>& sample() {
    static const std::vector<uint8_t> bytes = saved();
    return bytes;
}

}  // namespace

extern "C" size_t LLVMFuzzerCustomMutator(uint8_t* data, size_t size, size_t maxSize, unsigned seed) {
    if (sample().size() <= maxSize && seed % 2 == 0) {
        std::copy(sample().begin(), sample().end(), data);
        size = sample().size();
    }
    return seed % 16 == 0 ? size : LLVMFuzzerMutate(data, size, maxSize);
}

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size) {
    using namespace obscura;
    const std::filesystem::path file = fuzz::file("voxels.vdb", {data, size});
    fuzz::expectOneLine([&] {
        const voxel::Sparse sparse = voxel::Sparse::load(file, "key");
        if (sparse.bricks() != 4) std::abort();  // it has the seal, so it is a sample
    });
    fuzz::expectOneLine([&] { voxel::Sparse::load(file, "another key"); });
    return 0;
}
