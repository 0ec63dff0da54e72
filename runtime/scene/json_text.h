// Text of JSON and of names, always UTF-8; counts.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>

#include <nlohmann/json.hpp>

namespace obscura::scene {

// A JSON value as text; indent -1: on one line. Bytes that are not UTF-8, which names of files may have, become U+FFFD.
template <class Json>
std::string dump(const Json& json, int indent = -1) {
    return json.dump(indent, ' ', false, Json::error_handler_t::replace);
}

// A whole number from 0 on, of 32 bits; throws an exception of the JSON library for any other value.
template <class Json>
uint32_t count(const Json& json) {
    const auto number = json.template get_ref<const typename Json::number_unsigned_t&>();
    if (number > UINT32_MAX) throw Json::out_of_range::create(406, "number above 32 bits", &json);
    return uint32_t(number);
}

// A name for reports: bytes that are not UTF-8 become U+FFFD.
inline std::string utf8(std::string_view name) { return nlohmann::json::parse(dump(nlohmann::json(name))).get<std::string>(); }

}  // namespace obscura::scene
