// The block's variable becomes a private copy: main() begins with copy = pushed; copy.count = constant; and all other code reads the copy.
#include "gpu_cost/fixed_constants.h"

#include <cstring>
#include <map>

namespace obscura::gpu_cost {
namespace {

// Opcodes, storage classes and decorations of the SPIR-V specification.
enum : uint32_t {
    kEntryPoint = 15,
    kTypeInt = 21,
    kTypeFloat = 22,
    kTypeVector = 23,
    kTypeArray = 28,
    kTypeStruct = 30,
    kTypePointer = 32
};
enum : uint32_t { kConstant = 43, kConstantComposite = 44, kFunction = 54, kVariable = 59, kLoad = 61, kStore = 62, kAccessChain = 65 };
enum : uint32_t { kDecorate = 71, kMemberDecorate = 72, kLoopMerge = 246, kLabel = 248 };
enum : uint32_t { kPrivate = 6, kPushConstant = 9, kArrayStride = 6, kOffset = 35 };
enum : uint32_t { kUnroll = 1, kDontUnroll = 2 };
constexpr size_t kHeaderWords = 5;

using Words = std::vector<uint32_t>;

class Module {
public:
    Module(std::span<const uint32_t> spirv, std::span<const std::byte> constants, bool unroll)
        : m_spirv(spirv), m_bytes(constants), m_unroll(unroll) {}

    Words fixed() {
        if (m_spirv.size() < kHeaderWords) return {m_spirv.begin(), m_spirv.end()};
        m_bound = m_spirv[3];
        forEach([&](std::span<const uint32_t> op, uint32_t code) { learn(op, code); });
        m_result.assign(m_spirv.begin(), m_spirv.begin() + kHeaderWords);
        m_pushed = m_bound++;
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
        if (code == kTypeInt && op[2] == 32 && !m_int) m_int = op[1];  // the first: it stands before the variable
        if (code == kDecorate && op.size() > 3 && op[2] == kArrayStride) m_strides[op[1]] = op[3];
        if (code == kMemberDecorate && op.size() > 4 && op[3] == kOffset) m_offsets[{op[1], op[2]}] = op[4];
        if (code == kVariable && op[3] == kPushConstant) m_copy = op[2];
        if (code == kEntryPoint) m_main = op[2];
    }

    void rewrite(std::span<const uint32_t> op, uint32_t code) {
        if (code == kFunction) m_inMain = op[2] == m_main;
        // Behind the variables at the start of main().
        if (m_copy && m_inMain && !m_started && m_labelled && code != kVariable) start();
        if (code == kLabel && m_inMain) m_labelled = true;

        Words copy(op.begin(), op.end());
        if (code == kEntryPoint && m_copy) {
            copy.push_back(m_pushed);
            copy[0] += 1u << 16;
        }
        if (code == kTypePointer && op[2] == kPushConstant) copy[2] = kPrivate;
        if (code == kLoopMerge && m_unroll) copy[3] = (copy[3] | kUnroll) & ~uint32_t(kDontUnroll);
        if (code == kVariable && op[3] == kPushConstant) {
            m_block = m_definitions[op[1]][3];
            const uint32_t pointer = define({4u << 16 | kTypePointer, m_bound, kPushConstant, m_block});
            emit({4u << 16 | kVariable, pointer, m_pushed, kPushConstant});
            collect(m_block, 0, {});
            copy[3] = kPrivate;
        }
        emit(copy);
    }

    void start() {
        m_started = true;
        const uint32_t whole = m_bound++;
        emit({4u << 16 | kLoad, m_block, whole, m_pushed});
        emit({3u << 16 | kStore, m_copy, whole});
        for (const Count& count : m_counts) {
            const uint32_t place = m_bound++;
            Words chain{uint32_t(4 + count.path.size()) << 16 | kAccessChain, count.pointer, place, m_copy};
            chain.insert(chain.end(), count.path.begin(), count.path.end());
            emit(chain);
            emit({3u << 16 | kStore, place, count.value});
        }
    }

    // Defines a constant for each integer of the type, found at `offset` of the push constants; path: constants that index it.
    void collect(uint32_t type, uint32_t offset, const Words& path) {
        const std::span<const uint32_t> op = m_definitions[type];
        if (op.empty()) return;
        const uint32_t code = op[0] & 0xffffu;
        const auto below = [&](uint32_t part, uint32_t index, uint32_t at) {
            Words longer = path;
            longer.push_back(constant(m_int, index));
            collect(part, at, longer);
        };
        if (code == kTypeInt)
            m_counts.push_back({path, define({4u << 16 | kTypePointer, m_bound, kPrivate, type}), constant(type, word(offset))});
        if (code == kTypeVector && (m_definitions[op[2]][0] & 0xffffu) == kTypeInt) {
            Words vector{(3u + op[3]) << 16 | kConstantComposite, type, 0};
            for (uint32_t i = 0; i < op[3]; ++i) vector.push_back(constant(op[2], word(offset + 4 * i)));
            vector[2] = m_bound;
            const uint32_t value = define(vector);
            m_counts.push_back({path, define({4u << 16 | kTypePointer, m_bound, kPrivate, type}), value});
        }
        if (code == kTypeArray)
            for (uint32_t i = 0; i < m_definitions[op[3]][3]; ++i) below(op[2], i, offset + m_strides[type] * i);
        if (code == kTypeStruct)
            for (uint32_t i = 0; i + 2 < op.size(); ++i) below(op[2 + i], i, offset + m_offsets[{type, i}]);
    }

    uint32_t constant(uint32_t type, uint32_t value) { return define({4u << 16 | kConstant, type, m_bound, value}); }
    uint32_t define(const Words& op) {  // whose result is m_bound
        emit(op);
        return m_bound++;
    }
    void emit(const Words& op) { m_result.insert(m_result.end(), op.begin(), op.end()); }
    uint32_t word(uint32_t offset) const {
        uint32_t value = 0;
        if (offset + 4 <= m_bytes.size()) std::memcpy(&value, m_bytes.data() + offset, 4);
        return value;
    }

    struct Count {
        Words path;
        uint32_t pointer, value;
    };
    std::span<const uint32_t> m_spirv;
    std::span<const std::byte> m_bytes;
    const bool m_unroll;
    Words m_result;
    uint32_t m_bound = 0, m_int = 0, m_main = 0;
    uint32_t m_pushed = 0, m_copy = 0, m_block = 0;  // the new push-constant variable, the old one, the block's type
    bool m_inMain = false, m_labelled = false, m_started = false;
    std::vector<Count> m_counts;
    std::map<uint32_t, std::span<const uint32_t>> m_definitions;  // types and scalar constants by id
    std::map<uint32_t, uint32_t> m_strides;
    std::map<std::pair<uint32_t, uint32_t>, uint32_t> m_offsets;  // of (struct, member)
};

}  // namespace

std::vector<uint32_t> withFixedConstants(std::span<const uint32_t> spirv, std::span<const std::byte> constants, bool unroll) {
    return Module(spirv, constants, unroll).fixed();
}

}  // namespace obscura::gpu_cost
