#include "picture/aov.h"

#include <algorithm>

namespace limn {
namespace {

std::vector<const Aov*>& registry() {
    static std::vector<const Aov*> aovs;
    return aovs;
}

}  // namespace

Aov::Aov(std::string_view name_, Format format_, std::array<std::string_view, 4> channels_, AovKind kind_, AovUse use_,
    std::string_view doc_, std::string_view onlyBy_)
    : name(name_), format(format_), channels(channels_), kind(kind_), use(use_), doc(doc_), onlyBy(onlyBy_) {
    if (use == AovUse::betweenPasses) return;
    auto& all = registry();
    all.insert(
        std::upper_bound(all.begin(), all.end(), this, [](auto* a, auto* b) { return a->name < b->name; }), this);
}

int Aov::channelCount() const {
    return static_cast<int>(
        std::count_if(channels.begin(), channels.end(), [](auto channel) { return !channel.empty(); }));
}

const std::vector<const Aov*>& allAovs() { return registry(); }

const Aov* findAov(std::string_view name) {
    for (const Aov* aov : allAovs())
        if (aov->name == name) return aov;
    return nullptr;
}

}  // namespace limn
