// A parsed TOML value with its place. Plain data: every layer can read settings without the TOML library.
#pragma once

#include "base/error.h"

#include <cstdint>
#include <string>
#include <utility>
#include <variant>
#include <vector>

namespace limn {

struct Node {
    using Array = std::vector<Node>;
    using Table = std::vector<std::pair<std::string, Node>>;  ///< in the order written

    Location where;
    std::variant<bool, std::int64_t, double, std::string, Array, Table> value = Table{};
    Location keyWhere{};  ///< place of this value's key; empty for array elements

    bool isTable() const { return std::holds_alternative<Table>(value); }
    bool isArray() const { return std::holds_alternative<Array>(value); }
    bool isNumber() const {
        return std::holds_alternative<double>(value) || std::holds_alternative<std::int64_t>(value);
    }
    const Table& table() const { return std::get<Table>(value); }
    const Array& array() const { return std::get<Array>(value); }
    const std::string* text() const { return std::get_if<std::string>(&value); }
    double number() const {
        return isNumber() ? std::holds_alternative<double>(value) ? std::get<double>(value)
                                                                  : static_cast<double>(std::get<std::int64_t>(value))
                          : 0.0;
    }

    /// The entry of a table, or null.
    const Node* find(std::string_view key) const {
        if (!isTable()) return nullptr;
        for (const auto& [name, node] : table())
            if (name == key) return &node;
        return nullptr;
    }
    Node* find(std::string_view key) { return const_cast<Node*>(std::as_const(*this).find(key)); }

    /// "a number", "a table" ...: for messages.
    std::string_view kindName() const {
        constexpr std::string_view names[] = {"true/false", "a whole number", "a number", "text", "a list", "a table"};
        return names[value.index()];
    }
};

}  // namespace limn
