#include "scene/json_at.h"

#include <algorithm>

#include <fmt/format.h>

namespace obscura::scene {

std::string errorLine(std::string_view file, std::string_view pointer, std::string_view what) {
    std::string line = pointer.empty() ? fmt::format("{}: {}", file, what) : fmt::format("{}: {}: {}", file, pointer, what);
    // Names inside the file can contain line breaks; an error must not.
    for (char& c : line)
        if (static_cast<unsigned char>(c) < 0x20 || c == 0x7f) c = '?';
    constexpr size_t kLongest = 600;
    if (line.size() > kLongest) line = line.substr(0, kLongest) + "...";
    return line;
}

void JsonAt::fail(std::string_view what) const { throw Error(errorLine(*m_file, m_pointer, what)); }

JsonAt JsonAt::at(const char* key) const {
    expectObject();
    const auto it = m_json->find(key);
    if (it == m_json->end()) fail(fmt::format("\"{}\" is missing", key));
    return JsonAt(*m_file, *it, m_pointer + "/" + key);
}

std::optional<JsonAt> JsonAt::find(const char* key) const {
    expectObject();
    const auto it = m_json->find(key);
    if (it == m_json->end()) return std::nullopt;
    return JsonAt(*m_file, *it, m_pointer + "/" + key);
}

JsonAt JsonAt::at(size_t index) const { return JsonAt(*m_file, (*m_json)[index], m_pointer + "/" + std::to_string(index)); }

const JsonAt& JsonAt::expectObject() const {
    if (!m_json->is_object()) fail(fmt::format("must be an object, not {}", m_json->type_name()));
    return *this;
}

const JsonAt& JsonAt::expectArray() const {
    if (!m_json->is_array()) fail(fmt::format("must be an array, not {}", m_json->type_name()));
    return *this;
}

void JsonAt::only(std::initializer_list<std::string_view> keys) const {
    expectObject();
    for (const auto& item : m_json->items())
        if (std::find(keys.begin(), keys.end(), item.key()) == keys.end())
            fail(fmt::format("unknown field \"{}\"; use {}", item.key(), fmt::join(keys, ", ")));
}

std::string JsonAt::text() const {
    if (!m_json->is_string()) fail(fmt::format("must be a string, not {}", m_json->type_name()));
    return m_json->get<std::string>();
}

bool JsonAt::truth() const {
    if (!m_json->is_boolean()) fail(fmt::format("must be true or false, not {}", m_json->type_name()));
    return m_json->get<bool>();
}

uint64_t JsonAt::whole(uint64_t low, uint64_t high) const {
    if (!m_json->is_number_unsigned()) fail("must be a whole number, 0 or more");
    const uint64_t value = m_json->get<uint64_t>();
    if (value < low || value > high) fail(fmt::format("{} is out of range; use {} to {}", value, low, high));
    return value;
}

double JsonAt::number(double low, double high) const {
    if (!m_json->is_number()) fail(fmt::format("must be a number, not {}", m_json->type_name()));
    const double value = m_json->get<double>();
    if (!(value >= low && value <= high)) fail(fmt::format("{} is out of range; use {} to {}", value, low, high));
    return value;
}

void JsonAt::expectNumbers(size_t count) const {
    expectArray();
    if (size() != count) fail(fmt::format("must have {} numbers, has {}", count, size()));
    for (size_t i = 0; i < count; ++i) at(i).number();
}

size_t JsonAt::index(size_t count, const char* what) const {
    if (!m_json->is_number_unsigned()) fail(fmt::format("must be a whole number: the {}'s index", what));
    const uint64_t value = m_json->get<uint64_t>();
    if (value >= count) fail(fmt::format("{} {} does not exist: there are {}, counted from 0", what, value, count));
    return size_t(value);
}

}  // namespace obscura::scene
