#include "base/content_key.h"

#include <fmt/format.h>
#include <xxhash.h>

namespace limn {

std::string ContentKey::hex() const { return fmt::format("{:016x}{:016x}", high, low); }

struct KeyBuilder::State {
    XXH3_state_t* xxh = XXH3_createState();
    ~State() { XXH3_freeState(xxh); }
};

KeyBuilder::KeyBuilder() : state_(std::make_unique<State>()) { XXH3_128bits_reset(state_->xxh); }
KeyBuilder::~KeyBuilder() = default;

KeyBuilder& KeyBuilder::bytes(const void* data, std::size_t size) {
    XXH3_128bits_update(state_->xxh, data, size);
    return *this;
}

KeyBuilder& KeyBuilder::add(std::string_view text) { return add(text.size()).bytes(text.data(), text.size()); }

ContentKey KeyBuilder::key() const {
    const XXH128_hash_t hash = XXH3_128bits_digest(state_->xxh);
    return {hash.low64, hash.high64};
}

ContentKey contentKey(std::string_view bytes) {
    const XXH128_hash_t hash = XXH3_128bits(bytes.data(), bytes.size());
    return {hash.low64, hash.high64};
}

}  // namespace limn
