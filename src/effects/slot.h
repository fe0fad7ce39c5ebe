// Slots are the places for techniques in the pipeline: one row each, in the order in which they run. These rows give
// the keys of a config, the order of passes, the output of `limn techniques` and the cases of the stability suite.
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
        chain,   ///< one, or a list: each works on the result of the one before it
        layers,  ///< one, or a list: each lies over the one before it
    };

    std::string_view name;      ///< of src/effects/<name>/
    std::string_view key;       ///< a config's key for it: "ao"; "ao.filter" stands within the table of slot "ao"
    std::string_view fallback;  ///< the technique where a config chooses none; empty: none
    Fill fill = Fill::one;
    std::vector<const Aov*> promises;    ///< AOVs that a technique of the slot publishes, unless it draws nothing
    const Aov* worksOn = nullptr;        ///< the AOV that a technique of the slot changes
    int (*rate)(const View&) = nullptr;  ///< default of passes (picture/sampling.h); null: every sample
    std::string_view doc;

    /// Its name in messages: "[ao]", "filter of [ao]", "[[edges]]".
    std::string label() const;
    /// The slot whose table holds it; empty where it has its own.
    std::string_view parent() const;
    /// The last part of its key.
    std::string_view ownKey() const;
};

/// In the order in which they run.
std::span<const Slot> allSlots();
/// Null if there is none of that name.
const Slot* findSlot(std::string_view name);

}  // namespace limn
