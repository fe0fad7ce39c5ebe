// What the readers of OBJ and MTL share: lines, words, numbers, and warnings that come once per kind.
#pragma once

#include "mesh/poly_mesh.h"

#include <algorithm>
#include <charconv>
#include <cstdint>
#include <limits>
#include <map>
#include <string>
#include <string_view>
#include <vector>

namespace limn {

inline bool isBlank(char c) { return c == ' ' || c == '\t' || c == '\r' || c == '\v' || c == '\f'; }

/// Reads words and numbers from one line.
struct Cursor {
    const char* at;
    const char* end;

    void skipBlanks() {
        while (at < end && isBlank(*at)) ++at;
    }
    bool atEnd() {
        skipBlanks();
        return at == end;
    }
    std::string_view word() {
        skipBlanks();
        const char* start = at;
        while (at < end && !isBlank(*at)) ++at;
        return {start, static_cast<std::size_t>(at - start)};
    }
    std::string_view rest() {
        skipBlanks();
        const char* last = end;
        while (last > at && isBlank(last[-1])) --last;
        return {at, static_cast<std::size_t>(last - at)};
    }
    bool number(double& value) {
        skipBlanks();
        if (at < end && *at == '+') ++at;
        const auto [next, status] = std::from_chars(at, end, value);
        if (status == std::errc::result_out_of_range) {  // 1e999: as unusable as infinity, but well-formed
            value = std::numeric_limits<double>::infinity();
        } else if (status != std::errc()) {
            return false;
        }
        at = next;
        return at == end || isBlank(*at);
    }
    bool integer(std::int64_t& value) {
        const auto [next, status] = std::from_chars(at, end, value);
        if (status != std::errc()) return false;
        at = next;
        return true;
    }
};

/// Calls `use(line, lineNumber)` for each logical line: continuations joined, comments and line ends removed.
template <class Use>
int forEachLine(std::string_view text, Use&& use) {
    int line = 0;
    std::string joined;
    int joinedFrom = 0;
    while (!text.empty()) {
        const auto end = std::min(text.find('\n'), text.size());
        std::string_view content = text.substr(0, end);
        text.remove_prefix(std::min(end + 1, text.size()));
        ++line;
        if (content.ends_with('\r')) content.remove_suffix(1);
        const bool continues = content.ends_with('\\');
        if (continues) content.remove_suffix(1);
        if (continues || !joined.empty()) {
            if (joined.empty()) joinedFrom = line;
            joined.append(content).push_back(' ');
            if (continues && !text.empty()) continue;
            use(std::string_view(joined), joinedFrom);
            joined.clear();
        } else {
            use(content, line);
        }
    }
    return line;
}

struct WarningList {
    std::map<std::string, MeshWarning, std::less<>> kinds;

    void add(std::string_view kind, int line, std::size_t count = 1) {
        auto it = kinds.find(kind);
        if (it == kinds.end()) it = kinds.emplace(kind, MeshWarning{std::string(kind), 0, line}).first;
        it->second.count += count;
        it->second.firstLine = std::min(it->second.firstLine, line);
    }
    std::vector<MeshWarning> list() const {
        std::vector<MeshWarning> result;
        for (const auto& [kind, warning] : kinds) result.push_back(warning);
        std::stable_sort(
            result.begin(), result.end(), [](const auto& a, const auto& b) { return a.firstLine < b.firstLine; });
        return result;
    }
};

}  // namespace limn
