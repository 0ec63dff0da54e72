// A JSON value with its file name and JSON pointer, for error messages. Readers throw Error if type or range is wrong.
#pragma once

#include <cfloat>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

#include <nlohmann/json.hpp>

#include "scene/gltf/gltf.h"

namespace obscura::scene {

// "file: /pointer: what". Control characters become '?'; lines of more than 600 characters are cut.
std::string errorLine(std::string_view file, std::string_view pointer, std::string_view what);

class JsonAt {
public:
    using Json = nlohmann::json;
    static constexpr uint64_t kLargest = uint64_t(1) << 53;  // up to here a double holds integers exactly

    JsonAt(const std::string& file, const Json& json, std::string pointer = {})
        : m_file(&file), m_json(&json), m_pointer(std::move(pointer)) {}

    const Json& json() const { return *m_json; }
    const std::string& pointer() const { return m_pointer; }
    [[noreturn]] void fail(std::string_view what) const;

    // Members and elements.
    bool has(const char* key) const { return m_json->contains(key); }
    JsonAt at(const char* key) const;                   // fails if missing
    std::optional<JsonAt> find(const char* key) const;  // empty if missing
    JsonAt at(size_t index) const;                      // of an array, index < size()
    size_t size() const { return m_json->size(); }
    const JsonAt& expectObject() const;
    const JsonAt& expectArray() const;
    void only(std::initializer_list<std::string_view> keys) const;  // fails on any other member

    // Values.
    std::string text() const;
    bool truth() const;
    uint64_t whole(uint64_t low = 0, uint64_t high = kLargest) const;
    double number(double low = -double(FLT_MAX), double high = double(FLT_MAX)) const;
    void expectNumbers(size_t count) const;  // an array of exactly `count` numbers
    // Index into an array of `count` elements; `what` names an element in errors.
    size_t index(size_t count, const char* what) const;

private:
    const std::string* m_file;
    const Json* m_json;
    std::string m_pointer;
};

}  // namespace obscura::scene
