// Outlines of chosen objects, as in the paper on depth tangents (depth_tangent.cpp): the Laplacian of a mask with these
// objects in white and all else in black.
//
// Reads depth, geometric normals and object numbers; with materials those too. Writes edges. Objects are chosen by
// name, material or number. Without a choice every object's boundary is drawn: neighbours there have different numbers
// (a Laplacian of the numbers themselves would miss the middle of 1|2|3).
//
// Departs from the paper: any difference in the mask makes a line. The line has a width and runs where the object ends,
// to a fraction of a pixel. The paper's unsigned target kept the Laplacian's part outside the object: side = "outer".

#include "base/text.h"
#include "effects/edges/stroke.h"

#include <fmt/format.h>

#include <algorithm>

namespace limn {
namespace edges_laplacian {

struct Params {
    PictureLength width = PictureLength::pixels(2);
    Color color{0.0103f, 0.0103f, 0.0103f};  // #1a1a1a
    float opacity = 1;
    std::vector<std::string> objects, materials;
    std::vector<double> ids;
    LineSide side = LineSide::both;
};

constexpr Field kParams[] = {
    field<&Params::width>("width", {.unit = "picture", .min = 0, .max = 1000},
        "Width of the lines: pixels, \"0.35mm\" or \"0.2%\" of the image height."),
    field<&Params::color>("color", "Colour of the lines."),
    field<&Params::opacity>(
        "opacity", {.min = 0, .max = 1}, "How much the lines cover; at 0 they are not even computed."),
    field<&Params::objects>("objects",
        "Names of objects (of instances, or of parts of their files) to outline together; * and ? stand for any text "
        "and any letter."),
    field<&Params::materials>("materials", "Names of materials whose surfaces are outlined with them."),
    field<&Params::ids>("ids", {.min = 1}, "Numbers of objects, as the AOV object_id has them."),
    field<&Params::side>("side",
        "Lines lie half on what they outline and half off it (both), wholly on it (inner), or wholly off it (outer)."),
};

struct Constants {
    int firstMaterialWord = 0;
};
constexpr Field kConstants[] = {
    field<&Constants::firstMaterialWord>(
        "firstMaterialWord", "Where the bits of materials begin among those of objects."),
};

/// A set of numbers from 0, one bit each.
class Bits {
public:
    explicit Bits(std::size_t count) : words((count + 31) / 32) {}
    void set(std::size_t number) { words[number / 32] |= 1u << number % 32; }
    std::vector<std::uint32_t> words;
};

void complain(const std::string& what, const std::string& pattern, const std::vector<std::string>& known) {
    throw Error(
        ExitCode::usage, {}, fmt::format("laplacian: no {} is called '{}'", what, pattern), nameRemedy(pattern, known));
}

struct Chosen {
    Bits objects, materials;
};

Chosen choose(const Params& params, const SceneFacts& scene) {
    std::size_t last = 0;
    for (const auto& instance : scene.instances) last = std::max(last, instance.firstObject + instance.parts.size());
    Chosen chosen{Bits(last + 1), Bits(scene.materials.size() + 1)};
    for (const auto& pattern : params.objects) {
        bool found = false;
        std::vector<std::string> known;
        for (const auto& instance : scene.instances) {
            known.emplace_back(instance.name);
            for (std::size_t part = 0; part < instance.parts.size(); ++part) {
                if (!fitsPattern(pattern, instance.name) && !fitsPattern(pattern, instance.parts[part])) continue;
                chosen.objects.set(instance.firstObject + part);
                found = true;
            }
        }
        if (!found) complain("object", pattern, known);
    }
    for (const auto& pattern : params.materials) {
        bool found = false;
        std::vector<std::string> known;
        for (std::size_t i = 0; i < scene.materials.size(); ++i) {
            known.push_back(scene.materials[i].name);
            if (fitsPattern(pattern, scene.materials[i].name)) {
                chosen.materials.set(i + 1);
                found = true;
            }
        }
        if (!found) complain("material", pattern, known);
    }
    for (const double id : params.ids) {
        if (id > static_cast<double>(last))
            throw Error(ExitCode::usage, {}, fmt::format("laplacian: there is no object {}", id),
                fmt::format("numbers go to {}; the AOV object_id shows them", last));
        chosen.objects.set(static_cast<std::size_t>(id));
    }
    return chosen;
}

void build(EffectBuilder& graph, const Params& params) {
    if (params.opacity <= 0 || params.width.amount <= 0) return;
    const ResourceId sides = graph.image("line_sides" + graph.layerSuffix(), Format::r32ui);
    Pass pass;
    pass.name = "laplacian" + graph.layerSuffix();
    pass.rate = lineRate(graph);
    pass.reads = {{"depth", graph.read(aov::depth), 1}, {"normalGeometric", graph.read(aov::normalGeometric), 1},
        {"objectId", graph.read(aov::objectId), 1}};
    pass.writes = {{"result", sides}};
    Constants constants;
    if (!params.objects.empty() || !params.materials.empty() || !params.ids.empty()) {
        Chosen chosen = choose(params, graph.scene());
        pass.defines.emplace_back("CHOSEN", "");
        auto words = std::move(chosen.objects.words);
        constants.firstMaterialWord = static_cast<int>(words.size());
        if (!params.materials.empty()) {
            pass.defines.emplace_back("CHOSEN_MATERIALS", "");
            pass.reads.push_back({"materialId", graph.read(aov::materialId), 1});
            words.insert(words.end(), chosen.materials.words.begin(), chosen.materials.words.end());
        }
        constexpr std::size_t kMostWords = 4000;  // of the 16 KiB that every device gives to a uniform block
        if (words.size() > kMostWords)
            throw Error(ExitCode::badData, {},
                "the scene has too many objects and materials for laplacian to choose among", "join objects");
        pass.params = paramsBlock(kConstants, constants);
        appendWords(pass.params, "chosen", words);
    }
    defineSources(pass);
    pass.note = "2 neighbours per pixel";
    graph.add(std::move(pass));
    Stroke stroke;
    stroke.styles[lineSource("OBJECT")] = {graph.view().pixels(params.width), params.color};
    stroke.opacity = params.opacity;
    stroke.side = params.side;
    strokeLines(graph, sides, stroke);
}

const Technique kLaplacian{"edges", "laplacian", "Outlines of chosen objects, or of all.", kParams, build,
    {{"paper", "As published: black, one pixel wide, outside the object.",
        "width = '1px', color = '#000000', side = 'outer'"}}};

}  // namespace edges_laplacian
}  // namespace limn
