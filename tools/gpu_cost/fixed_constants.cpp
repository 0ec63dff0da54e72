#include "gpu_cost/fixed_constants.h"

#include <cstring>
#include <map>

namespace obscura::gpu_cost {
namespace {

// Opcodes, storage classes and decorations of the SPIR-V specification.
enum : uint32_t {
    kTypeInt = 21,
    kTypeFloat = 22,
    kTypeVector = 23,
    kTypeMatrix = 24,
    kTypeArray = 28,
    kTypeStruct = 30,
    kTypePointer = 32
};
enum : uint32_t { kConstant = 43, kConstantComposite = 44, kVariable = 59, kDecorate = 71, kMemberDecorate = 72, kLoopMerge = 246 };
enum : uint32_t { kPrivate = 6, kPushConstant = 9, kArrayStride = 6, kMatrixStride = 7, kOffset = 35 };
enum : uint32_t { kUnroll = 1, kDontUnroll = 2 };
constexpr size_t kHeaderWords = 5;

class Module {
public:
    Module(std::span<const uint32_t> spirv, std::span<const std::byte> constants) : m_spirv(spirv), m_bytes(constants) {}

    std::vector<uint32_t> fixed() {
        if (m_spirv.size() < kHeaderWords) return {m_spirv.begin(), m_spirv.end()};
        m_bound = m_spirv[3];
        forEach([&](std::span<const uint32_t> op, uint32_t code) { learn(op, code); });
        m_result.assign(m_spirv.begin(), m_spirv.begin() + kHeaderWords);
        forEach([&](std::span<const uint32_t> op, uint32_t code) { rewrite(op, code); });
        m_result[3] = m_bound;
        return std::move(m_result);
    }

private:
    template <class Each> void forEach(Each each) {
        for (size_t at = kHeaderWords; at < m_spirv.size();) {
            const size_t words = m_spirv[at] >> 16;
            if (words == 0 || at + words > m_spirv.size()) return;
            each(m_spirv.subspan(at, words), m_spirv[at] & 0xffffu);
            at += words;
        }
    }

    void learn(std::span<const uint32_t> op, uint32_t code) {
        if ((code >= kTypeInt && code <= kTypePointer) || code == kConstant) m_definitions[op[code == kConstant ? 2 : 1]] = op;
        if (code == kDecorate && op.size() > 3 && op[2] == kArrayStride) m_strides[op[1]] = op[3];
        if (code == kMemberDecorate && op.size() > 4 && op[3] == kOffset) m_offsets[{op[1], op[2]}] = op[4];
        if (code == kMemberDecorate && op.size() > 4 && op[3] == kMatrixStride) m_matrixStride = op[4];
    }

    void rewrite(std::span<const uint32_t> op, uint32_t code) {
        std::vector<uint32_t> copy(op.begin(), op.end());
        if (code == kTypePointer && op[2] == kPushConstant) copy[2] = kPrivate;
        if (code == kLoopMerge) copy[3] = (copy[3] | kUnroll) & ~uint32_t(kDontUnroll);
        if (code == kVariable && op[3] == kPushConstant) {
            const uint32_t value = make(m_definitions[op[1]][3], 0);
            copy = {5u << 16 | kVariable, op[1], op[2], kPrivate, value};
        }
        m_result.insert(m_result.end(), copy.begin(), copy.end());
    }

    uint32_t word(uint32_t offset) const {
        uint32_t value = 0;
        if (offset + 4 <= m_bytes.size()) std::memcpy(&value, m_bytes.data() + offset, 4);
        return value;
    }

    // Writes the constant of that type at `offset` of the push constants; returns its id.
    uint32_t make(uint32_t type, uint32_t offset) {
        const std::span<const uint32_t> op = m_definitions[type];
        const uint32_t code = op[0] & 0xffffu;
        std::vector<uint32_t> parts;
        if (code == kTypeInt || code == kTypeFloat) return emit({4u << 16 | kConstant, type, m_bound, word(offset)});
        if (code == kTypeVector)
            for (uint32_t i = 0; i < op[3]; ++i) parts.push_back(make(op[2], offset + 4 * i));
        if (code == kTypeMatrix)
            for (uint32_t i = 0; i < op[3]; ++i) parts.push_back(make(op[2], offset + m_matrixStride * i));
        if (code == kTypeArray)
            for (uint32_t i = 0; i < m_definitions[op[3]][3]; ++i) parts.push_back(make(op[2], offset + m_strides[type] * i));
        if (code == kTypeStruct)
            for (uint32_t i = 0; i + 2 < op.size(); ++i) parts.push_back(make(op[2 + i], offset + m_offsets[{type, i}]));
        std::vector<uint32_t> composite{uint32_t(3 + parts.size()) << 16 | kConstantComposite, type, m_bound};
        composite.insert(composite.end(), parts.begin(), parts.end());
        return emit(std::move(composite));
    }
    uint32_t emit(std::vector<uint32_t> op) {
        m_result.insert(m_result.end(), op.begin(), op.end());
        return m_bound++;
    }

    std::span<const uint32_t> m_spirv;
    std::span<const std::byte> m_bytes;
    std::vector<uint32_t> m_result;
    uint32_t m_bound = 0, m_matrixStride = 16;
    std::map<uint32_t, std::span<const uint32_t>> m_definitions;  // types and scalar constants by id
    std::map<uint32_t, uint32_t> m_strides;
    std::map<std::pair<uint32_t, uint32_t>, uint32_t> m_offsets;  // of (struct, member)
};

}  // namespace

std::vector<uint32_t> withFixedConstants(std::span<const uint32_t> spirv, std::span<const std::byte> constants) {
    return Module(spirv, constants).fixed();
}

}  // namespace obscura::gpu_cost
