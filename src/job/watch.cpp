#include "job/watch.h"

#include "base/file.h"
#include "base/log.h"
#include "job/run.h"
#include "settings/document.h"

#include <fmt/format.h>

#include <chrono>
#include <map>
#include <optional>
#include <set>
#include <thread>

namespace limn {
namespace {

using namespace std::chrono_literals;

/// Twice this without a change and a file has been written.
constexpr auto kPause = 40ms;
/// Of a scene that cannot be read, so many files of its folder are watched at most.
constexpr std::size_t kMostFiles = 10000;

/// Sizes and times of files; nullopt where there is none.
using Stamps = std::map<std::filesystem::path, Session::Stamp>;

Stamps stampsOf(const std::set<std::filesystem::path>& files) {
    Stamps stamps;
    for (const auto& file : files) stamps[file] = Session::stampOf(file);
    return stamps;
}

class Watch {
public:
    explicit Watch(const RunOptions& options) : options_(options), session_(options.session) {}

    void draw() {
        const Stamps before = stampsOf(configFiles());
        std::vector<Error> errors;
        collect(errors, [&] { runJobs(options_, session_); });
        for (const auto& error : errors) log::error("{}", error.message);
        watched_ = before;
        // A file that was changed while the picture was drawn counts as changed.
        for (const auto& [file, stamp] : session_.files()) watched_[file] = stamp;
        if (errors.empty()) return;
        session_.forgetAll();
        for (auto& [file, stamp] : stampsOf(filesBeside())) watched_.emplace(file, stamp);
    }

    /// Returns when a file has changed, and is no longer being written.
    void wait() {
        Stamps now;
        std::vector<std::filesystem::path> changed;
        while (changed.empty()) {
            std::this_thread::sleep_for(kPause);
            for (const auto& [file, stamp] : watched_)
                if (Session::stampOf(file) != stamp) changed.push_back(file);
        }
        for (Stamps last; last.empty() || last != now; std::swap(last, now)) {
            now = stampsOf({changed.begin(), changed.end()});
            std::this_thread::sleep_for(kPause);
        }
        log::info("{} changed", changed.front().string());
        session_.forgetChanged();
    }

private:
    /// The configs and what they include.
    std::set<std::filesystem::path> configFiles() const {
        std::set<std::filesystem::path> files;
        for (const auto& config : options_.configs) {
            files.insert(config);
            std::vector<Error> ignored;  // drawing says the same
            collect(ignored, [&] {
                std::vector<std::filesystem::path> included;
                const Node document = readDocument(config, &included);
                files.insert(included.begin(), included.end());
                if (const Node* scene = document.find("scene"); scene && scene->text())
                    files.insert(std::filesystem::path(config).parent_path() / *scene->text());
            });
        }
        return files;
    }

    /// The files in the folders of what is watched, where nobody knows which of them is at fault.
    std::set<std::filesystem::path> filesBeside() const {
        std::set<std::filesystem::path> folders, files;
        for (const auto& [file, stamp] : watched_)
            folders.insert(file.parent_path().empty() ? "." : file.parent_path());
        for (const auto& folder : folders) {
            std::error_code failed;
            for (auto entry = std::filesystem::recursive_directory_iterator(folder, failed);
                 !failed && entry != std::filesystem::recursive_directory_iterator() && files.size() < kMostFiles;
                 entry.increment(failed))
                if (entry->is_regular_file(failed)) files.insert(entry->path().lexically_normal());
        }
        return files;
    }

    const RunOptions& options_;
    Session session_;
    Stamps watched_;
};

}  // namespace

void watchJobs(const RunOptions& options, const std::function<bool()>& isEnough) {
    Watch watch(options);
    for (watch.draw(); !isEnough(); watch.draw()) watch.wait();
}

}  // namespace limn
