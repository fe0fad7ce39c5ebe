// limn's own scene files, in TOML.
#pragma once

#include "formats/format.h"
#include "settings/fields.h"

namespace limn {

std::vector<SettingsTable> sceneTables();

/// Reads and checks a scene file; every problem at once (Errors). Files it names are not opened, but must exist. What
/// was read, includes among it, is added to `files`.
Scene readScene(const std::filesystem::path& path, std::vector<std::filesystem::path>* files = nullptr);
Scene parseScene(const Node& document, const std::filesystem::path& path);

}  // namespace limn
