// Small text helpers that several layers share.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace limn {

/// The candidate closest to `word` by edit distance, if it is close enough to be what was meant.
std::optional<std::string> nearestName(std::string_view word, std::span<const std::string> candidates);
/// "did you mean 'x'?" when something is near, else "it can be a, b or c".
/// Does a name fit a pattern: * for any letters, ? for one, [abc] for one of these?
bool fitsPattern(const std::string& pattern, std::string_view name);
std::string nameRemedy(std::string_view word, std::span<const std::string> candidates);

/// As a message may show it: control characters, which names can hold, as "\x1b"; what is longer than kLongestMessage
/// without its middle.
std::string presentable(std::string_view text);
inline constexpr std::size_t kLongestMessage = 300;  ///< bytes

/// ASCII letters made small; all else as it is.
std::string lowerCase(std::string_view text);

/// "a, b and c"
std::string joinAnd(std::span<const std::string> words);
/// "a, b or c"
std::string joinOr(std::span<const std::string> words);

/// Locale-free. nullopt unless the whole text is one finite number.
std::optional<double> parseNumber(std::string_view text);

/// The shortest text that reads back as the same number.
std::string numberText(double value);

/// A JSON string literal, quotes included.
std::string jsonText(std::string_view text);

/// The text as XML and PDF may hold it: bytes that are no UTF-8, and control characters, become U+FFFD.
std::string repairedText(std::string_view text);

/// Text for a shell, quoted where necessary.
std::string shellText(const std::string& text);

/// "12.3 MiB"
std::string bytesText(std::uint64_t bytes);

}  // namespace limn
