#include "formats/find_file.h"

#include "base/file.h"
#include "base/text.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstdlib>
#include <vector>

namespace limn {
namespace {

namespace fs = std::filesystem;

/// What is looked at: a model's folder holds less, and somebody's home folder must not be searched for minutes.
constexpr std::size_t kMostFiles = 20000;
constexpr int kDeepest = 4;

bool isFile(const fs::path& path) {
    std::error_code unknown;
    return fs::is_regular_file(path, unknown);
}

/// The files in a folder and below, sorted. Nothing where there is more than one may look at.
std::vector<fs::path> filesBelow(const fs::path& folder) {
    std::vector<fs::path> files;
    std::error_code error;
    auto entry = fs::recursive_directory_iterator(
        folder.empty() ? "." : folder, fs::directory_options::skip_permission_denied, error);
    for (std::size_t looked = 0; !error && entry != fs::recursive_directory_iterator(); entry.increment(error)) {
        if (++looked > kMostFiles) return {};
        if (entry.depth() >= kDeepest) entry.disable_recursion_pending();
        if (isFile(entry->path())) files.push_back(entry->path());
    }
    std::sort(files.begin(), files.end());
    return files;
}

/// Without quotes, with slashes.
std::string cleaned(std::string_view written) {
    for (const char quote : {'"', '\''})
        if (written.size() > 1 && written.front() == quote && written.back() == quote)
            written = written.substr(1, written.size() - 2);
    std::string name(written);
    std::replace(name.begin(), name.end(), '\\', '/');
    const char* home = std::getenv("HOME");
    if (name.starts_with("~/") && home) name = home + name.substr(1);
    return name;
}

}  // namespace

NamedFile findNamedFile(std::string_view written, const fs::path& folder) {
    // A name may hold a quote or a backslash of its own.
    if (const auto exact = folder / written; isFile(exact)) return {exact, ""};
    const std::string name = cleaned(written);
    if (const auto meant = folder / name; isFile(meant)) return {meant, ""};

    const auto files = filesBelow(folder);
    const std::string last = fs::path(name).filename().string();
    const auto isCalled = [&](const fs::path& file, bool anyCase) {
        const std::string other = file.filename().string();
        return anyCase ? lowerCase(other) == lowerCase(last) : other == last;
    };
    for (const bool anyCase : {false, true}) {
        const auto matches = [&](const fs::path& file) { return isCalled(file, anyCase); };
        if (std::count_if(files.begin(), files.end(), matches) != 1) continue;
        const fs::path found = *std::find_if(files.begin(), files.end(), matches);
        return {found, fmt::format("is found as '{}'", found.lexically_relative(folder).string())};
    }

    std::vector<std::string> names, places;
    for (const auto& file : files) {
        if (isCalled(file, true)) places.push_back(fmt::format("'{}'", file.lexically_relative(folder).string()));
        names.push_back(lowerCase(file.filename().string()));
    }
    if (!places.empty()) return {{}, fmt::format("several files are called so: {}", joinOr(places))};
    const auto nearest = nearestName(lowerCase(last), names);
    if (!nearest) return {};
    const auto at = static_cast<std::size_t>(std::find(names.begin(), names.end(), *nearest) - names.begin());
    return {{}, fmt::format("did you mean '{}'?", files[at].lexically_relative(folder).string())};
}

}  // namespace limn
