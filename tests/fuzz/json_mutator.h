// Changes a value of a JSON document, since most changes of raw bytes fail in the JSON parser.
#pragma once

#include <algorithm>
#include <random>

#include <nlohmann/json.hpp>

namespace obscura::fuzz {

using Json = nlohmann::json;

inline Json anyValue(std::mt19937& random, const Json& old) {
    switch (random() % 12) {
        case 0: return -1;
        case 1: return random() % 4;
        case 2: return random() % 100;
        case 3: return uint64_t(1) << (random() % 63);
        case 4: return 1e30;
        case 5: return "text";
        case 6: return nullptr;
        case 7: return Json::array();
        case 8: return Json::object();
        case 9: return old.is_number() ? Json(old.get<double>() + 1) : Json(true);
        case 10: return old.is_number_integer() ? Json(old.get<uint64_t>() * 2) : Json(0);
        default: return Json::array({old, old});
    }
}

inline void mutateJson(Json& json, std::mt19937& random) {
    // Descends to a random depth; leaves are likelier than their parents.
    Json* at = &json;
    Json* parent = nullptr;
    while (at->is_structured() && !at->empty() && (parent == nullptr || random() % 8 != 0)) {
        parent = at;
        at = &*std::next(at->begin(), ptrdiff_t(random() % at->size()));
    }
    if (at->is_string() && at->get_ref<const std::string&>().starts_with("data:") && random() % 4 != 0) {
        std::string& uri = at->get_ref<std::string&>();
        const size_t start = uri.find(',') + 1;
        static constexpr char kDigits[] = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
        for (size_t i = 0; start < uri.size() && i <= random() % 4; ++i)
            uri[start + random() % (uri.size() - start)] = kDigits[random() % 64];
        return;
    }
    if (parent != nullptr && parent->is_array() && random() % 6 == 0) {
        parent->push_back(Json(*at));
    } else if (parent != nullptr && random() % 6 == 0) {
        if (parent->is_array()) parent->erase(random() % parent->size());
        else parent->erase(std::next(parent->begin(), ptrdiff_t(random() % parent->size())).key());
    } else {
        *at = anyValue(random, *at);
    }
}

}  // namespace obscura::fuzz
