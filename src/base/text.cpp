#include "base/text.h"

#include <fmt/format.h>
#include <fnmatch.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <numeric>

namespace limn {
namespace {

/// Levenshtein distance in which swapping two neighbouring letters counts as one slip, since that is how people
/// mistype.
int editDistance(std::string_view a, std::string_view b) {
    std::vector<std::vector<int>> d(a.size() + 1, std::vector<int>(b.size() + 1));
    for (std::size_t i = 0; i <= a.size(); ++i) d[i][0] = static_cast<int>(i);
    for (std::size_t j = 0; j <= b.size(); ++j) d[0][j] = static_cast<int>(j);
    for (std::size_t i = 1; i <= a.size(); ++i) {
        for (std::size_t j = 1; j <= b.size(); ++j) {
            d[i][j] = std::min({d[i - 1][j] + 1, d[i][j - 1] + 1, d[i - 1][j - 1] + (a[i - 1] != b[j - 1])});
            if (i > 1 && j > 1 && a[i - 1] == b[j - 2] && a[i - 2] == b[j - 1])
                d[i][j] = std::min(d[i][j], d[i - 2][j - 2] + 1);
        }
    }
    return d[a.size()][b.size()];
}

}  // namespace

std::optional<std::string> nearestName(std::string_view word, std::span<const std::string> candidates) {
    // A third of the letters may differ: enough for slips, too little to suggest an unrelated word.
    int best = static_cast<int>(std::max<std::size_t>(word.size(), 3) / 3) + 1;
    std::optional<std::string> nearest;
    for (const auto& candidate : candidates) {
        const int distance = editDistance(word, candidate);
        if (distance < best) {
            best = distance;
            nearest = candidate;
        }
    }
    return nearest;
}

bool fitsPattern(const std::string& pattern, std::string_view name) {
    return fnmatch(pattern.c_str(), std::string(name).c_str(), 0) == 0;
}

std::string nameRemedy(std::string_view word, std::span<const std::string> candidates) {
    if (candidates.empty()) return "nothing can stand here";
    if (const auto nearest = nearestName(word, candidates)) return fmt::format("did you mean '{}'?", *nearest);
    return "it can be " + joinOr(candidates);
}

std::string presentable(std::string_view text) {
    std::string shown;
    for (std::size_t i = 0; i < text.size() && shown.size() < 100 * kLongestMessage; ++i) {
        const auto byte = static_cast<unsigned char>(text[i]);
        // The second half of the controls has two bytes in UTF-8.
        const auto next = i + 1 < text.size() ? static_cast<unsigned char>(text[i + 1]) : 0;
        const bool isSecondHalf = byte == 0xC2 && next >= 0x80 && next < 0xA0;
        if (byte < 0x20 || byte == 0x7F || isSecondHalf)
            shown += fmt::format("\\x{:02x}", isSecondHalf ? next : byte);
        else
            shown += text[i];
        i += isSecondHalf;
    }
    if (shown.size() <= kLongestMessage) return shown;
    // The end says what to do about it.
    constexpr std::string_view gap = " … ";
    std::size_t head = kLongestMessage / 2, tail = shown.size() - (kLongestMessage - gap.size() - head);
    const auto continues = [&](std::size_t at) { return (static_cast<unsigned char>(shown[at]) & 0xC0u) == 0x80u; };
    while (head > 0 && continues(head)) --head;
    while (tail < shown.size() && continues(tail)) ++tail;
    return shown.substr(0, head) + std::string(gap) + shown.substr(tail);
}

static std::string join(std::span<const std::string> words, std::string_view last) {
    std::string text;
    for (std::size_t i = 0; i < words.size(); ++i)
        text += std::string(i == 0 ? "" : i + 1 == words.size() ? last : ", ") + words[i];
    return text;
}

std::string joinOr(std::span<const std::string> words) { return join(words, " or "); }
std::string joinAnd(std::span<const std::string> words) { return join(words, " and "); }

std::optional<double> parseNumber(std::string_view text) {
    double value = 0;
    const auto [end, status] = std::from_chars(text.data(), text.data() + text.size(), value);
    if (status != std::errc() || end != text.data() + text.size() || !std::isfinite(value)) return std::nullopt;
    return value;
}

std::string numberText(double value) {
    // Values that came through a float print as that float, not with the digits the widening invented.
    const float narrow = static_cast<float>(value);
    return static_cast<double>(narrow) == value ? fmt::format("{}", narrow) : fmt::format("{}", value);
}

/// Length of the UTF-8 sequence that begins the text, or 0 where there is none.
static std::size_t utf8Length(std::string_view text) {
    const auto byte = [&](std::size_t i) { return static_cast<unsigned char>(text[i]); };
    const std::size_t length = byte(0) < 0x80 ? 1
        : byte(0) >= 0xc2 && byte(0) < 0xe0   ? 2
        : byte(0) >= 0xe0 && byte(0) < 0xf0   ? 3
        : byte(0) >= 0xf0 && byte(0) < 0xf5   ? 4
                                              : 0;
    if (length == 0 || length > text.size()) return 0;
    for (std::size_t i = 1; i < length; ++i)
        if ((byte(i) & 0xc0) != 0x80) return 0;
    return length;
}

std::string jsonText(std::string_view text) {
    std::string result = "\"";
    while (!text.empty()) {
        const std::size_t length = utf8Length(text);
        if (length == 0) {  // names in files may be in any encoding; JSON is UTF-8
            result += "\\ufffd";
            text.remove_prefix(1);
            continue;
        }
        const char c = text.front();
        if (c == '"' || c == '\\') result += '\\';
        if (static_cast<unsigned char>(c) < 0x20)
            result += fmt::format("\\u{:04x}", static_cast<int>(c));
        else
            result += text.substr(0, length);
        text.remove_prefix(length);
    }
    return result + '"';
}

std::string repairedText(std::string_view text) {
    std::string result;
    while (!text.empty()) {
        const std::size_t known = utf8Length(text), length = std::max<std::size_t>(known, 1);
        const bool isBad = known == 0 || static_cast<unsigned char>(text.front()) < 0x20;
        result += isBad ? std::string_view("\xEF\xBF\xBD") : text.substr(0, length);
        text.remove_prefix(length);
    }
    return result;
}

std::string bytesText(std::uint64_t bytes) {
    if (bytes < 1024) return fmt::format("{} B", bytes);
    const char* units[] = {"KiB", "MiB", "GiB", "TiB"};
    double amount = static_cast<double>(bytes) / 1024;
    int unit = 0;
    while (amount >= 1024 && unit < 3) {
        amount /= 1024;
        ++unit;
    }
    return fmt::format("{:.1f} {}", amount, units[unit]);
}

std::string lowerCase(std::string_view text) {
    std::string lower(text);
    for (char& c : lower)
        if (c >= 'A' && c <= 'Z') c = static_cast<char>(c - 'A' + 'a');
    return lower;
}

std::string shellText(const std::string& text) {
    const std::string_view safe = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789/._-+=:,@%";
    if (!text.empty() && text.find_first_not_of(safe) == std::string::npos) return text;
    std::string result = "'";
    for (const char c : text) result += c == '\'' ? "'\\''" : std::string(1, c);
    return result + "'";
}

}  // namespace limn
