#include "config/document.h"

#include "base/file.h"
#include "base/text.h"

#include <fmt/format.h>
// The parser asserts what it then reports as an error: a slip in a file must not end a debug build.
#define TOML_ASSERT(expr) static_cast<void>(0)
#include <toml++/toml.h>

#include <algorithm>

namespace limn {
namespace {

Location place(const toml::source_region& source, const std::string& file) { return {file, static_cast<int>(source.begin.line), static_cast<int>(source.begin.column)}; }

Node convert(const toml::node& node, const std::string& file) {
    Node result;
    result.where = place(node.source(), file);
    if (const auto* table = node.as_table()) {
        Node::Table entries;
        for (const auto& [key, value] : *table) {
            Node entry = convert(value, file);
            entry.keyWhere = place(key.source(), file);
            // Only toml++ knows the header of [table]: it points at the bracket, which is the better place for "this table lacks…".
            entries.emplace_back(std::string(key.str()), std::move(entry));
        }
        // toml++ sorts keys by name; people think in the order they wrote.
        std::stable_sort(entries.begin(), entries.end(), [](const auto& a, const auto& b) {
            return std::pair(a.second.keyWhere.line, a.second.keyWhere.column) < std::pair(b.second.keyWhere.line, b.second.keyWhere.column);
        });
        result.value = std::move(entries);
    } else if (const auto* array = node.as_array()) {
        Node::Array elements;
        for (const auto& value : *array) elements.push_back(convert(value, file));
        result.value = std::move(elements);
    } else if (const auto* text = node.as_string()) {
        result.value = text->get();
    } else if (const auto* integer = node.as_integer()) {
        result.value = integer->get();
    } else if (const auto* number = node.as_floating_point()) {
        result.value = number->get();
    } else if (const auto* boolean = node.as_boolean()) {
        result.value = boolean->get();
    } else {
        throw Error(ExitCode::usage, result.where, "dates and times have no meaning here", "write text in quotes or a number");
    }
    return result;
}

void merge(Node& below, Node&& above) {
    if (!below.isTable() || !above.isTable()) {
        below = std::move(above);
        return;
    }
    for (auto& [key, node] : std::get<Node::Table>(above.value)) {
        if (Node* existing = below.find(key)) {
            Location keyWhere = node.keyWhere;
            merge(*existing, std::move(node));
            existing->keyWhere = std::move(keyWhere);
        } else {
            std::get<Node::Table>(below.value).emplace_back(key, std::move(node));
        }
    }
    below.where = above.where;
}

Node readLayered(const std::filesystem::path& path, std::vector<std::filesystem::path>& open, std::vector<std::filesystem::path>* files, const Location& from) {
    std::error_code unknown;
    const auto key = std::filesystem::weakly_canonical(path, unknown);
    if (std::find(open.begin(), open.end(), key) != open.end())
        throw Error(ExitCode::usage, from, fmt::format("'{}' includes itself", path.string()), "remove one of the includes");
    std::string text;
    try {
        text = readFile(path);
    } catch (Error& error) {
        if (!from.file.empty()) throw Error(error.code, from, fmt::format("the included file '{}' {}", path.string(), error.problem), error.remedy);
        throw;
    }
    if (files) files->push_back(path);
    Node document = parseDocument(text, path.string());
    Node* include = document.find("include");
    if (!include) return document;

    open.push_back(key);
    const Node list = include->isArray() ? *include : Node{include->where, Node::Array{*include}};
    Node layered;
    for (const auto& entry : list.array()) {
        if (!entry.text()) throw Error(ExitCode::usage, entry.where, "'include' must be a list of file names", "write include = [\"style.toml\"]");
        const auto target = path.parent_path() / *entry.text();
        merge(layered, readLayered(target, open, files, entry.where));
    }
    open.pop_back();
    auto& entries = std::get<Node::Table>(document.value);
    std::erase_if(entries, [](const auto& entry) { return entry.first == "include"; });
    merge(layered, std::move(document));
    return layered;
}

/// Letters beyond ASCII belong into quotes and comments. toml++ 3.3 runs into undefined behaviour where some of them stand elsewhere
/// (its table of blanks has no answer for U+00A0 … U+0499): they are found first.
void checkLetters(std::string_view text, const std::string& name) {
    std::string_view quote;   // the one that is open
    bool comment = false;
    int line = 1, column = 1;
    for (std::size_t i = 0; i < text.size(); ++i, ++column) {
        const char c = text[i];
        if (c == '\n') {
            comment = false, ++line, column = 0;
            if (quote.size() == 1) quote = {};   // not closed: toml++ will say so
        } else if (comment) {
            continue;
        } else if (!quote.empty()) {
            if (c == '\\' && quote[0] == '"') ++i, ++column;
            else if (text.substr(i).starts_with(quote)) i += quote.size() - 1, column += static_cast<int>(quote.size()) - 1, quote = {};
        } else if (c == '#') {
            comment = true;
        } else if (c == '"' || c == '\'') {
            const bool three = text.substr(i).size() >= 3 && text[i + 1] == c && text[i + 2] == c;
            quote = text.substr(i, three ? 3 : 1);
            if (three) i += 2, column += 2;
        } else if (static_cast<unsigned char>(c) >= 0x80) {
            throw Error(ExitCode::usage, {name, line, column}, "a letter beyond ASCII stands outside quotes", "put the text into quotes");
        }
    }
}

}  // namespace

Node parseDocument(std::string_view text, const std::string& name) {
    if (text.starts_with("\xEF\xBB\xBF")) text.remove_prefix(3);
    checkLetters(text, name);
    try {
        return convert(toml::parse(text, name), name);
    } catch (const toml::parse_error& error) {
        throw Error(ExitCode::usage, place(error.source(), name), std::string(error.description()), "see https://toml.io for the syntax");
    }
}

Node readDocument(const std::filesystem::path& path, std::vector<std::filesystem::path>* files) {
    std::vector<std::filesystem::path> open;
    return readLayered(path, open, files, {});
}

void applySetting(Node& document, std::string_view setting) {
    const Location where{fmt::format("--set {}", setting), 0, 0};
    const auto equals = setting.find('=');
    if (equals == std::string_view::npos || equals == 0) throw Error(ExitCode::usage, where, "this is not KEY=VALUE", "write for example --set ao.radius=0.4");
    const std::string text(setting.substr(equals + 1));

    Node value;
    try {
        value = *parseDocument("value = " + text, where.file).find("value");
    } catch (const Error&) {
        value.value = text;  // bare words and units: toon, 2px, #1a1a1a
    }
    // Whatever stands inside came from the command line too.
    const auto setPlace = [&](auto&& self, Node& node) -> void {
        node.where = node.keyWhere = where;
        if (auto* array = std::get_if<Node::Array>(&node.value)) for (auto& element : *array) self(self, element);
        if (auto* table = std::get_if<Node::Table>(&node.value)) for (auto& entry : *table) self(self, entry.second);
    };
    setPlace(setPlace, value);

    Node* node = &document;
    std::string_view path = setting.substr(0, equals);
    while (true) {
        const auto dot = path.find('.');
        const std::string key(path.substr(0, dot));
        if (auto* array = std::get_if<Node::Array>(&node->value)) {
            const auto index = parseNumber(key);
            if (!index && array->size() == 1) {  // "edges.width" when there is one layer
                node = &array->front();
                continue;
            }
            if (!index || *index < 0 || *index >= static_cast<double>(array->size()) || *index != static_cast<double>(static_cast<std::size_t>(*index)))
                throw Error(ExitCode::usage, where, fmt::format("'{}' is no entry of a list with {} entries", key, array->size()), "count from 0, for example edges.0.width");
            node = &(*array)[static_cast<std::size_t>(*index)];
        } else {
            if (!node->isTable()) throw Error(ExitCode::usage, where, fmt::format("'{}' lies inside a value that is not a table", key), "");
            if (!node->find(key)) {
                std::get<Node::Table>(node->value).emplace_back(key, Node{where, Node::Table{}, where});
            } else if (dot != std::string_view::npos && !node->find(key)->isTable() && !node->find(key)->isArray()) {
                *node->find(key) = Node{where, Node::Table{}, where};
            }
            node = node->find(key);
        }
        if (dot == std::string_view::npos) break;
        path = path.substr(dot + 1);
    }
    *node = std::move(value);
}

std::filesystem::path pathIn(const Node& node) {
    const std::filesystem::path path = *node.text();
    // What was typed on the command line counts from where one stands.
    if (node.where.file.starts_with("--set ")) return path.lexically_normal();
    return (std::filesystem::path(node.where.file).parent_path() / path).lexically_normal();
}

std::string canonicalText(const Node& node) {
    struct Visitor {
        std::string operator()(bool value) const { return value ? "true" : "false"; }
        std::string operator()(std::int64_t value) const { return std::to_string(value); }
        std::string operator()(double value) const { return fmt::format("{}", value); }
        std::string operator()(const std::string& value) const { return fmt::format("\"{}:{}\"", value.size(), value); }
        std::string operator()(const Node::Array& array) const {
            std::string text = "[";
            for (const auto& element : array) text += canonicalText(element) + ",";
            return text + "]";
        }
        std::string operator()(const Node::Table& table) const {
            std::vector<std::string> entries;
            for (const auto& [key, value] : table) entries.push_back(key + "=" + canonicalText(value));
            std::sort(entries.begin(), entries.end());
            std::string text = "{";
            for (const auto& entry : entries) text += entry + ",";
            return text + "}";
        }
    };
    return std::visit(Visitor{}, node.value);
}

}  // namespace limn
