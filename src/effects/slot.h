// The places in the making of a picture that techniques fill: one row each, in the order in which they run. What a
// config may say, how the passes are put together, what `limn techniques` prints and what the stability suite tries all
// come from these rows.
#pragma once

#include "picture/aov.h"
#include "picture/view.h"

#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace limn {

struct Slot {
    /// How many techniques may fill it.
    enum class Fill {
        one,     ///< a table, or a technique's name
        chain,   ///< one, or a list: each works on what the one before it has made
        layers,  ///< one, or a list: each lies over the one before it
    };

    std::string_view name;      ///< of src/effects/<name>/
    std::string_view key;       ///< where a config chooses: "ao"; "ao.filter" stands within the table of slot "ao"
    std::string_view fallback;  ///< the technique where a config chooses none; empty: then there is none
    Fill fill = Fill::one;
    std::vector<const Aov*> promises;    ///< what a technique of the slot publishes, unless it draws nothing
    const Aov* worksOn = nullptr;        ///< what a technique of the slot changes
    int (*rate)(const View&) = nullptr;  ///< of passes that do not say (picture/sampling.h); null: every sample
    std::string_view doc;

    /// As messages call it: "[ao]", "filter of [ao]", "[[edges]]".
    std::string label() const;
    /// The slot in whose table it stands; empty where it has its own.
    std::string_view parent() const;
    /// The last part of its key.
    std::string_view ownKey() const;
};

/// In the order in which they run.
std::span<const Slot> allSlots();
/// Null where there is none of that name.
const Slot* findSlot(std::string_view name);

}  // namespace limn
