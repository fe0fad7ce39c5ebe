// Configs: what `limn techniques` prints is what a config accepts, and format versions.

#include "render/config.h"
#include "formats/scene_file.h"
#include "settings/document.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

namespace limn {
namespace {

RenderConfig parse(const std::string& text) {
    return parseRenderConfig(parseDocument("scene = '/dev/null'\n" + text, "test.toml"), "test.toml");
}

std::string problems(const std::function<void()>& work) {
    ErrorCollector errors;
    errors.run(work);
    std::string all;
    for (const auto& error : errors.list()) all += error.message + "\n";
    return all;
}

/// The config's lines that choose a technique with these settings.
std::string choosing(const Technique& technique, const std::string& settings) {
    const Slot& slot = *findSlot(technique.slot);
    const std::string table = fmt::format("{{ technique = '{}'{} }}", technique.name, settings);
    if (slot.parent().empty()) return fmt::format("{} = {}\n", slot.key, table);
    return fmt::format("{} = {{ technique = 'hbao', {} = {} }}\n", slot.parent(), slot.ownKey(), table);
}

TEST(Config, acceptsEveryKeyThatTechniquesHave) {
    int keys = 0;
    for (const Technique* technique : allTechniques()) {
        ASSERT_NE(findSlot(technique->slot), nullptr) << technique->slot;
        EXPECT_EQ(problems([&] { parse(choosing(*technique, "")); }), "") << technique->name;
        const auto defaults = technique->makeParams();
        for (const auto& field : technique->schema) {
            const std::string value = field.type().text(field.constMember(defaults.get()));
            EXPECT_EQ(problems([&] { parse(choosing(*technique, fmt::format(", {} = {}", field.name, value))); }), "")
                << technique->slot << " " << technique->name << "." << field.name << " = " << value;
            ++keys;
        }
        for (const auto& preset : technique->presets)
            EXPECT_EQ(problems([&] { parse(choosing(*technique, fmt::format(", preset = '{}'", preset.name))); }), "");
        // And nothing else.
        EXPECT_NE(problems([&] { parse(choosing(*technique, ", no_such_key = 1")); }).find("unknown key 'no_such_key'"),
            std::string::npos);
    }
    EXPECT_GT(keys, 100);
}

TEST(Config, acceptsEveryAovThatItsSlotsMake) {
    for (const Aov* aov : allAovs()) {
        std::string config;
        for (const auto& slot : allSlots()) {
            const bool promises = std::find(slot.promises.begin(), slot.promises.end(), aov) != slot.promises.end();
            const Technique* only = findTechnique(slot.name, aov->onlyBy);
            if ((promises || only) && slot.fallback.empty() && slot.parent().empty())
                config = fmt::format("{} = '{}'\n", slot.key,
                    only                    ? only->name
                        : slot.name == "ao" ? "hbao"
                                            : "depth_normal");
        }
        const std::string output = fmt::format("output.aovs = ['{}']\n", aov->name);
        EXPECT_EQ(problems([&] { parse(config + output); }), "") << aov->name;
        const bool isRefused = problems([&] { parse(output); }).find("nothing makes the AOV") != std::string::npos;
        EXPECT_EQ(isRefused, !config.empty()) << aov->name;
    }
}

TEST(Config, settingsGoIntoATechniqueThatStandsByItsNameAlone) {
    ConfigOverrides overrides;
    overrides.settings = {"shading.bands=3", "ao.filter.iterations=2", "edges.0.width=4px"};
    const Node document = parseDocument(
        "scene = '/dev/null'\nshading = 'toon'\nedges = ['depth_normal']\n[ao]\ntechnique = 'hbao'\nfilter = "
        "'gaussian'\n",
        "test.toml");
    const RenderConfig config = parseRenderConfig(document, "test.toml", overrides);
    const auto value = [&](std::string_view slot, std::string_view name) {
        const TechniqueChoice& choice = config.in(slot).front();
        const Field& field = *findField(choice.technique->schema, name);
        return field.type().text(field.constMember(choice.params.get()));
    };
    EXPECT_EQ(value("shading", "bands"), "3");
    EXPECT_EQ(value("filter", "iterations"), "2");
    EXPECT_EQ(value("edges", "width"), "\"4px\"");
}

TEST(Versions, ofFilesThatAreNewerAreRefused) {
    for (const char* version : {"", "version = 1\n"}) {
        EXPECT_EQ(problems([&] { parse(version); }), "");
        const Node scene =
            parseDocument(std::string(version) + "[[mesh]]\nname = 'm'\nfile = '/dev/null'\n", "scene.toml");
        EXPECT_EQ(problems([&] { parseScene(scene, "scene.toml"); }), "");
    }
    for (const char* what : {"2", "99"}) {
        const std::string version = fmt::format("version = {}\n", what);
        EXPECT_NE(problems([&] {
            parse(version);
        }).find("is of format version " + std::string(what) + ", and this limn reads up to 1"),
            std::string::npos);
        const Node scene = parseDocument(version + "[[mesh]]\nname = 'm'\nfile = '/dev/null'\n", "scene.toml");
        EXPECT_NE(problems([&] { parseScene(scene, "scene.toml"); }).find("scene.toml:1"), std::string::npos);
    }
    for (const char* what : {"0", "'new'", "1.5"})
        EXPECT_NE(problems([&] { parse(fmt::format("version = {}\n", what)); }).find("must be a whole number from 1"),
            std::string::npos);
}

}  // namespace
}  // namespace limn
