// Dependencies point one way, as the table of rooms in src/README.md says: over everything that an include brings
// along, forward declarations among it, and libraries stay in the rooms that are named for them.

#include "base/file.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <map>
#include <regex>
#include <set>
#include <string>
#include <vector>

namespace limn {
namespace {

const std::filesystem::path kSource = std::filesystem::path(LIMN_SOURCE_DIR) / "src";

struct Room {
    std::set<std::string> mayInclude, libraries;
};

std::vector<std::string> linesOf(const std::string& text) {
    std::vector<std::string> lines{""};
    for (const char c : text) c == '\n' ? void(lines.emplace_back()) : void(lines.back() += c);
    return lines;
}

/// Words in backticks.
std::set<std::string> quoted(const std::string& cell) {
    std::set<std::string> words;
    const std::regex word("`([^`]+)`");
    for (std::sregex_iterator at(cell.begin(), cell.end(), word), end; at != end; ++at) words.insert((*at)[1]);
    return words;
}

/// The rows `| `room/` | what it holds | rooms | libraries |`. A room may include itself, the rooms named, and what
/// those may.
std::map<std::string, Room> readTable() {
    std::map<std::string, Room> rooms;
    const std::regex row(R"(\| `(\w+)/` \|([^|]*)\|([^|]*)\|([^|]*)\|)");
    for (const auto& line : linesOf(readFile(kSource / "README.md"))) {
        std::smatch match;
        if (!std::regex_match(line, match, row)) continue;
        Room& room = rooms[match[1]];
        room.mayInclude = {match[1]};
        for (const auto& other : quoted(match[3])) {
            EXPECT_TRUE(rooms.contains(other)) << match[1] << " may include " << other << ", which comes after it";
            room.mayInclude.insert(rooms[other].mayInclude.begin(), rooms[other].mayInclude.end());
        }
        room.libraries = quoted(match[4]);
    }
    return rooms;
}

struct File {
    std::vector<std::string> includes, libraries, declares;
};

std::map<std::string, File> readFiles() {
    std::map<std::string, File> files;
    const std::regex include(R"re(#include "(\w+/[^"]+)")re"), library(R"(#include <([^>/]+)(/[^>]*)?>)");
    const std::regex declaration(R"((class|struct|enum class) (\w+);)");
    for (const auto& entry : std::filesystem::recursive_directory_iterator(kSource)) {
        if (entry.path().extension() != ".h" && entry.path().extension() != ".cpp") continue;
        File& file = files[std::filesystem::relative(entry.path(), kSource).string()];
        for (const auto& line : linesOf(readFile(entry.path()))) {
            std::smatch match;
            if (std::regex_match(line, match, include)) file.includes.push_back(match[1]);
            if (std::regex_match(line, match, library)) file.libraries.push_back(match[1]);
            if (std::regex_match(line, match, declaration)) file.declares.push_back(match[2]);
        }
    }
    return files;
}

std::string roomOf(const std::string& file) { return file.substr(0, file.find('/')); }

void collectIncludes(const std::map<std::string, File>& files, const std::string& file, std::set<std::string>& all) {
    const auto found = files.find(file);
    if (found == files.end()) return;
    for (const auto& include : found->second.includes)
        if (all.insert(include).second) collectIncludes(files, include, all);
}

TEST(Arrows, everyRoomHasARow) {
    const auto rooms = readTable();
    for (const auto& entry : std::filesystem::directory_iterator(kSource)) {
        const bool isRoom = entry.is_directory();
        EXPECT_TRUE(!isRoom || rooms.contains(entry.path().filename())) << entry.path();
    }
    for (const auto& [name, room] : rooms) EXPECT_TRUE(std::filesystem::is_directory(kSource / name)) << name;
}

TEST(Arrows, includesPointOneWay) {
    const auto rooms = readTable();
    const auto files = readFiles();
    int checked = 0;
    for (const auto& [name, file] : files) {
        if (!rooms.contains(roomOf(name))) continue;  // main.cpp
        std::set<std::string> all;
        collectIncludes(files, name, all);
        for (const auto& include : all) {
            if (!files.contains(include)) continue;
            EXPECT_TRUE(rooms.at(roomOf(name)).mayInclude.contains(roomOf(include))) << name << " sees " << include;
            ++checked;
        }
    }
    EXPECT_GT(checked, 1000);
}

// What a header only names, it must be allowed to include as well.
TEST(Arrows, forwardDeclarationsPointOneWay) {
    const auto rooms = readTable();
    const auto files = readFiles();
    std::map<std::string, std::string> definedIn;
    const std::regex definition(R"((class|struct|enum class) (\w+) (final )?(:.*)?\{.*)");
    for (const auto& [name, file] : files)
        for (const auto& line : linesOf(readFile(kSource / name))) {
            std::smatch match;
            if (std::regex_match(line, match, definition)) definedIn[match[2]] = roomOf(name);
        }
    int checked = 0;
    for (const auto& [name, file] : files)
        for (const auto& type : file.declares) {
            if (!definedIn.contains(type) || !rooms.contains(roomOf(name))) continue;
            EXPECT_TRUE(rooms.at(roomOf(name)).mayInclude.contains(definedIn[type])) << name << " names " << type;
            ++checked;
        }
    EXPECT_GT(checked, 2);
}

TEST(Arrows, librariesStayInTheirRooms) {
    const auto rooms = readTable();
    std::set<std::string> known;
    for (const auto& [name, room] : rooms) known.insert(room.libraries.begin(), room.libraries.end());
    ASSERT_TRUE(known.contains("epoxy") && known.contains("embree3") && known.contains("opensubdiv"));
    // Headers of the language and the system, and the libraries that serve everybody.
    const std::set<std::string> everywhere{"fmt", "glm", "tbb", "sys"};
    for (const auto& [name, file] : readFiles()) {
        if (!rooms.contains(roomOf(name))) continue;
        for (const auto& library : file.libraries) {
            const bool isStandard = library.find('.') == std::string::npos && !known.contains(library);
            if (everywhere.contains(library) || isStandard) continue;
            EXPECT_TRUE(rooms.at(roomOf(name)).libraries.contains(library)) << name << " includes <" << library << ">";
        }
    }
}

}  // namespace
}  // namespace limn
