// What outlives a run, and what it may take: messages, memory, temporaries.

#include "base/file.h"
#include "base/memory.h"
#include "base/text.h"

#include <fmt/format.h>
#include <gtest/gtest.h>
#include <signal.h>
#include <sys/wait.h>
#include <unistd.h>

#include <chrono>
#include <fstream>
#include <memory>

namespace limn {
namespace {

namespace fs = std::filesystem;

TEST(Messages, showNoControlCharacters) {
    EXPECT_EQ(presentable("plain Größe 木"), "plain Größe 木");
    EXPECT_EQ(presentable("a\x1b[31mb\nc\x7f\xC2\x9B"), "a\\x1b[31mb\\x0ac\\x7f\\x9b");
    const Error error(ExitCode::usage, {"fi\x07le.toml", 3, 4}, "'\x1b' is unknown");
    EXPECT_EQ(error.message, "fi\\x07le.toml:3:4: '\\x1b' is unknown");
}

TEST(Messages, areCutInTheMiddle) {
    for (const std::size_t length : {299u, 300u, 301u, 5000u}) {
        const std::string text = "begin" + std::string(length - 8, 'x') + "end";
        const std::string shown = presentable(text);
        EXPECT_LE(shown.size(), kLongestMessage);
        EXPECT_TRUE(shown.starts_with("begin") && shown.ends_with("end")) << shown;
        EXPECT_EQ(shown == text, length <= kLongestMessage);
    }
    std::string letters;
    for (int i = 0; i < 400; ++i) letters += "木";
    const std::string shown = presentable(letters);
    const auto gap = shown.find(" … ");
    ASSERT_NE(gap, std::string::npos);
    EXPECT_EQ(gap % 3, 0u) << "no letter is cut in two";
    EXPECT_EQ((shown.size() - gap - 5) % 3, 0u);
}

TEST(Memory, readsSizes) {
    EXPECT_EQ(parseMemory("8G"), std::uint64_t{8} << 30);
    EXPECT_EQ(parseMemory("1.5m"), std::uint64_t{3} << 19);
    EXPECT_EQ(parseMemory("4096"), 4096u);
    EXPECT_EQ(parseMemory("2T"), std::uint64_t{2} << 40);
    for (const char* text : {"", "G", "0", "-1G", "lots", "1e30G", "nanG"}) EXPECT_FALSE(parseMemory(text)) << text;
}

TEST(Memory, isRefusedBeforeItIsTaken) {
    EXPECT_GT(memoryLimit(), std::uint64_t{1} << 28);
    setMemoryLimit(std::uint64_t{1} << 40);
    const auto claim = [](std::uint64_t bytes) {
        return std::make_unique<MemoryClaim>(bytes, Location{"f"}, "it is large", "mend");
    };
    {
        const auto first = claim(std::uint64_t{600} << 30);
        EXPECT_NO_THROW(claim(std::uint64_t{300} << 30));
        try {
            claim(std::uint64_t{500} << 30);
            FAIL() << "two claims add up";
        } catch (const Error& error) {
            EXPECT_EQ(error.code, ExitCode::outOfMemory);
            EXPECT_EQ(error.message.find("f: it is large and would need about 500.0 GiB, with 60"), 0u)
                << error.message;
            EXPECT_NE(error.message.find("1.0 TiB allowed; mend"), std::string::npos) << error.message;
        }
    }
    EXPECT_NO_THROW(claim(std::uint64_t{500} << 30)) << "what is given back is free again";
    EXPECT_THROW(claim(~std::uint64_t{0}), Error);
    setMemoryLimit(0);
}

class Temporaries : public testing::Test {
protected:
    Temporaries() { fs::create_directories(folder_); }
    ~Temporaries() override { fs::remove_all(folder_); }
    std::size_t count() const {
        std::size_t found = 0;
        for (const auto& entry : fs::directory_iterator(folder_))
            found += entry.path().filename().string().starts_with(".limn-");
        return found;
    }
    /// Writes files in processes that are killed in the midst of it, until one leaves its temporary behind.
    void writeAndBeKilled() const {
        for (int i = 0; i < 100 && count() == 0; ++i) {
            const pid_t child = ::fork();
            if (child == 0) {
                const std::string large(64 << 20, 'x');
                for (;;) replaceFile(folder_ / "picture", large);
            }
            while (count() == 0) ::usleep(200);
            ::kill(child, SIGKILL);
            int status = 0;
            ::waitpid(child, &status, 0);
        }
    }

    // Folders are swept once per process.
    fs::path folder_ = fs::temp_directory_path()
        / fmt::format("limn-{}-{}", testing::UnitTest::GetInstance()->current_test_info()->name(), ::getpid());
};

TEST_F(Temporaries, ofKilledProcessesAreSweptByTheNextOne) {
    writeAndBeKilled();
    ASSERT_EQ(count(), 1u) << "a kill in the midst of writing leaves one behind";
    replaceFile(folder_ / "picture", "whole");
    EXPECT_EQ(count(), 0u);
    EXPECT_EQ(readFile(folder_ / "picture"), "whole");
}

TEST_F(Temporaries, ofTheLivingAndOfOtherMachinesStay) {
    // Another process of this machine, at work.
    const pid_t child = ::fork();
    if (child == 0) {
        const std::string large(64 << 20, 'x');
        for (;;) replaceFile(folder_ / "other", large);
    }
    while (count() == 0) ::usleep(200);
    const auto old = fs::file_time_type::clock::now() - std::chrono::hours(25);
    const fs::path fresh = folder_ / ".limn-elsewhere-0123-pid4026-77-88-abcdef",
                   stale = folder_ / ".limn-elsewhere-0123-pid4026-77-88-abcdeg", earlier = folder_ / ".limn-abcdef",
                   notes = folder_ / ".limn-presets.toml";
    for (const auto& file : {fresh, stale, earlier, notes}) std::ofstream(file) << "x";
    fs::last_write_time(stale, old);
    fs::last_write_time(earlier, old);
    fs::last_write_time(notes, old);
    const pid_t sweeper = ::fork();
    if (sweeper == 0) {
        replaceFile(folder_ / "mine", "x");
        ::_exit(0);
    }
    int status = 0;
    ::waitpid(sweeper, &status, 0);
    EXPECT_EQ(status, 0);
    ::kill(child, SIGKILL);
    ::waitpid(child, &status, 0);
    EXPECT_TRUE(fs::exists(fresh)) << "perhaps at work, on another machine";
    EXPECT_FALSE(fs::exists(stale)) << "a day old";
    EXPECT_FALSE(fs::exists(earlier)) << "of a version that did not say whose";
    EXPECT_TRUE(fs::exists(notes)) << "somebody's own";
    EXPECT_TRUE(fs::exists(folder_ / "mine"));
}

TEST(Writable, isSaidBeforeAnythingIsDone) {
    EXPECT_THROW(requireWritable("/proc/nothing/stats.json"), Error);
    EXPECT_THROW(requireWritable("/"), Error);
    EXPECT_NO_THROW(requireWritable(fs::temp_directory_path() / "stats.json"));
}

}  // namespace
}  // namespace limn
