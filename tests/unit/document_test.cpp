// TOML documents that would cost minutes, gigabytes or the stack are refused in a sentence.

#include "settings/document.h"
#include "base/file.h"

#include <fmt/format.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>
#include <functional>

namespace limn {
namespace {

std::string problem(const std::function<void()>& work) {
    try {
        work();
    } catch (const Error& error) { return error.message; }
    return "";
}

std::string repeated(std::string_view text, int times) {
    std::string all;
    for (int i = 0; i < times; ++i) all += text;
    return all;
}

TEST(Document, refusesKeysThatNestTooDeep) {
    // 100 000 parts ended in a stack overflow.
    for (const std::string& text : {repeated("a.", 100000) + "a = 1", "[" + repeated("a.", 100000) + "a]",
             repeated("'a' . ", 100000) + "a = 1", "b = { " + repeated("a.", 100000) + "a = 1 }",
             "x = \"\"\"\n\"q\" \"\"\"\n" + repeated("a.", 100000) + "a = 1",
             "x = { b = \"\"\"q\"\"\"\", " + repeated("a.", 100000) + "a = 1 }"})
        EXPECT_NE(
            problem([&] { parseDocument(text, "deep"); }).find("this key has more than 32 parts"), std::string::npos)
            << text.substr(0, 40);
    EXPECT_EQ(problem([] { parseDocument("\nb = 1\n" + repeated("a.", 40) + "a = 1", "deep"); }),
        "deep:3:66: this key has more than 32 parts; no table lies that deep: look for the typo");
    // Levels of values have a bound of their own, so that 32 parts in each of them end as well.
    EXPECT_NE(problem([] { parseDocument("a = " + repeated("{ a.a.a.a = ", 1000), "deep"); }), "");
    EXPECT_NE(problem([] { parseDocument("a = " + repeated("[", 100000), "deep"); }), "");
}

TEST(Document, countsNoDotsOutsideOfKeys) {
    const std::string dots = repeated(".", 100);
    for (const std::string& text : {"a = '" + dots + "'", "a = \"\\\"" + dots + "\"", "a = 1 # " + dots + "\nb = 2",
             "a = \"\"\"\n" + dots + "\n\\\"\"\" " + dots + "\"\"\"", "a = '''\n" + dots + "'''",
             "a = [" + repeated("0.5, ", 100) + "]", repeated("a", 1) + " = 1\n[b.c.d]\ne.f.g = 0.5"})
        EXPECT_EQ(problem([&] { parseDocument(text, "flat"); }), "") << text.substr(0, 40);
}

class Files : public testing::Test {
protected:
    Files() { std::filesystem::create_directories(folder_); }
    ~Files() override { std::filesystem::remove_all(folder_); }
    std::filesystem::path write(const std::string& name, const std::string& text) {
        replaceFile(folder_ / name, text);
        return folder_ / name;
    }

private:
    std::filesystem::path folder_ = std::filesystem::temp_directory_path() / fmt::format("limn-unit-{}", ::getpid());
};

TEST_F(Files, thatIncludeOthersTwiceOverDoNotDoubleForEver) {
    write("30.toml", "a = 1");
    for (int i = 29; i >= 0; --i) {
        const std::string next = fmt::format("'{}.toml'", i + 1);
        write(fmt::format("{}.toml", i), fmt::format("include = [{0}, {0}]", next));
    }
    const auto first = write("first.toml", "include = '0.toml'");
    EXPECT_NE(problem([&] { readDocument(first); }).find("more than 1000 files are included"), std::string::npos);
    // Files that share an included one are no cycle.
    const auto shared = write("shared.toml", "include = ['30.toml', '30.toml']");
    std::vector<std::filesystem::path> read;
    EXPECT_NE(readDocument(shared, &read).find("a"), nullptr);
    EXPECT_EQ(read.size(), 3U);
}

TEST_F(Files, joinListsOfNamedThings) {
    write("own.toml", "[[light]]\nname = 'a'\nkind = 'point'\n[[light]]\nname = 'b'\n[[edges]]\nwidth = 1\n");
    const auto path = write("main.toml",
        "include = ['own.toml']\n[[light]]\nname = 'c'\n[[light]]\nname = 'a'\nrange = 2\n[[edges]]\nwidth = 2\n");
    const Node document = readDocument(path);
    const auto& lights = document.find("light")->array();
    ASSERT_EQ(lights.size(), 3U);
    EXPECT_NE(lights[0].find("kind"), nullptr);
    EXPECT_NE(lights[0].find("range"), nullptr);
    EXPECT_EQ(document.find("edges")->array().size(), 1U) << "without names: replaced";
}

TEST_F(Files, withoutAnEndAreRefused) {
    EXPECT_NE(problem([] { readDocument("/dev/zero"); }).find("is longer than 64 MiB"), std::string::npos);
    EXPECT_NE(problem([] { MappedFile("/dev/zero"); }).find("is a pipe or a device"), std::string::npos);
}

}  // namespace
}  // namespace limn
