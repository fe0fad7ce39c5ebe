// limn mesh: the content of a mesh file, and its subdivision.

#include "base/log.h"
#include "base/text.h"
#include "cli/commands.h"
#include "formats/inspect.h"
#include "settings/document.h"

#include <fmt/format.h>

#include <cstdio>

namespace limn::cli {
namespace {

struct Options {
    std::vector<std::string> files;
    std::string format = "text";
};

ExitCode run(const Options& options) {
    ErrorCollector errors;
    std::string json;
    for (const auto& file : options.files) {
        errors.run([&] {
            const MeshFacts facts = inspectMesh(file);
            if (options.format == "json")
                json += (json.empty() ? "" : ",\n") + meshFactsJson(facts);
            else
                fmt::print("{}{}", file == options.files.front() ? "" : "\n", meshFactsText(facts));
        });
    }
    if (options.format == "json") fmt::print("{{\"version\": {}, \"meshes\": [\n{}\n]}}\n", kFormatVersion, json);
    std::fflush(stdout);
    errors.throwIfAny();
    return ExitCode::done;
}

}  // namespace

void addMesh(CLI::App& app, Chosen& chosen) {
    auto options = std::make_shared<Options>();
    auto* command = app.add_subcommand("mesh", "Show what is in a mesh file and what subdivision will make of it");
    command->add_option("FILE", options->files, "OBJ files")->required();
    command->add_option("--format", options->format, "text or json")->check(CLI::IsMember({"text", "json"}));
    command->callback([options, &chosen] { chosen = [options] { return run(*options); }; });
}

}  // namespace limn::cli
