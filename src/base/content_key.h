// Content keys: two things with one content key are the same, whatever their names and origins.
#pragma once

#include <compare>
#include <concepts>
#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <type_traits>
#include <vector>

namespace limn {

/// 128 bits of XXH3 over all bytes. The hash is no secret, but different contents will not share one by chance.
struct ContentKey {
    std::uint64_t low = 0, high = 0;
    auto operator<=>(const ContentKey&) const = default;
    /// 32 hexadecimal digits.
    std::string hex() const;
};

/// Makes a content key of the values added, in order. Texts and lists add their lengths: "ab", "c" is not "a", "bc".
class KeyBuilder {
public:
    KeyBuilder();
    ~KeyBuilder();
    KeyBuilder(const KeyBuilder&) = delete;
    KeyBuilder& operator=(const KeyBuilder&) = delete;

    KeyBuilder& bytes(const void* data, std::size_t size);
    KeyBuilder& add(std::string_view text);
    template <class T>
    requires std::has_unique_object_representations_v<T> || std::floating_point<T> KeyBuilder& add(const T& value) {
        return bytes(&value, sizeof value);
    }
    template <class T>
    requires std::has_unique_object_representations_v<T> || std::floating_point<T> KeyBuilder& add(
        const std::vector<T>& values) {
        return add(values.size()).bytes(values.data(), values.size() * sizeof(T));
    }
    ContentKey key() const;

private:
    struct State;
    std::unique_ptr<State> state_;
};

/// The content key of some bytes.
ContentKey contentKey(std::string_view bytes);

}  // namespace limn
