// Files that other programs name: in another case, with backslashes, by a path of another machine.
#pragma once

#include <filesystem>
#include <string>
#include <string_view>

namespace limn {

struct NamedFile {
    std::filesystem::path path;  ///< empty: not found
    /// "is found as 'Textures/Brick.JPG'" where it lies elsewhere than written; where it is not found, a file of nearly
    /// that name, if there is one. Else empty.
    std::string remark;
};

/// The file that a text names, seen from `folder`. As written first: quotes around it and a ~ for the home folder are
/// understood, backslashes separate folders. Else the one file of that name, whatever the case of its letters, in the
/// folder or below it, if there is exactly one; letters in the same case go first.
NamedFile findNamedFile(std::string_view written, const std::filesystem::path& folder);

}  // namespace limn
