// TOML documents with the place of every value, includes, and settings layered on from the command line.
#pragma once

#include "settings/node.h"

#include <filesystem>
#include <span>
#include <string>

namespace limn {

/// Reads a TOML file and resolves `include = ["a.toml"]`. Included files are layered in order; the including file wins.
/// Tables merge key by key, lists of things with a `name` thing by thing; other values are replaced. Appends every file
/// read to `files`, if given. Throws Error: missing or unreadable file, TOML syntax, include cycles.
Node readDocument(const std::filesystem::path& path, std::vector<std::filesystem::path>* files = nullptr);

/// Parses TOML text; `name` stands for the file in messages.
Node parseDocument(std::string_view text, const std::string& name);

/// Layers `KEY=VALUE` onto a document: dots descend into tables, a number into a list ("edges.0.width=2px"). A value
/// that is not TOML counts as text, so quotes can be left out. Throws Error (usage).
void applySetting(Node& document, std::string_view setting);

/// The format version of configs, scenes, studies and JSON outputs: this program writes it, and reads none newer. A
/// file without `version` is of version 1. Files of older versions are read for ever, and brought up to date while
/// reading. A newer file is refused.
inline constexpr int kFormatVersion = 1;

/// Checks `version` of a document. `what` names the document in messages: "the config".
void readVersion(const Node& document, std::string_view what, ErrorCollector& errors);

/// The path that a text node names: relative to the node's file, or to the working directory if it came from --set.
std::filesystem::path pathIn(const Node& node);

/// A stable text form, for hashing: keys sorted, places left out.
std::string canonicalText(const Node& node);

}  // namespace limn
