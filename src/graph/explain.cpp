#include "base/text.h"
#include "graph/graph.h"
#include "settings/document.h"

#include <fmt/format.h>

#include <algorithm>

namespace limn {
namespace {

std::string joined(const std::vector<std::string>& words, std::string_view separator) {
    std::string text;
    for (const auto& word : words) text += (text.empty() ? "" : std::string(separator)) + word;
    return text;
}

std::string jsonList(const std::vector<std::string>& words) {
    std::vector<std::string> texts;
    texts.reserve(words.size());
    for (const auto& word : words) texts.push_back(jsonText(word));
    return "[" + joined(texts, ", ") + "]";
}

class Explainer {
public:
    Explainer(const Graph& graph, const Plan& plan, const PlanFacts& facts, std::span<const double> milliseconds)
        : graph_(graph), plan_(plan), facts_(facts), ms_(milliseconds) {}

    std::string text() const {
        std::string out;
        for (const auto& [name, value] : facts_) out += fmt::format("{:<12} {}\n", name, value);
        out += "\npasses\n";
        double total = 0;
        for (std::size_t i = 0; i < plan_.passes.size(); ++i) {
            const Pass& p = pass(plan_.passes[i]);
            std::string time;
            if (!ms_.empty()) {
                time = fmt::format("{:9.2f} ms", ms_[i]);
                total += ms_[i];
            }
            out += fmt::format("{:>3}  {:<24} {:<11} {:<16}{}\n", i + 1, p.name, p.slot, p.technique, time);
            out += fmt::format("       {} → {}{}\n", p.reads.empty() ? "the scene" : joined(reads(p), ", "),
                joined(writes(plan_.passes[i], true), ", "), "   (" + joined(remarks(p), ", ") + ")");
            out += fmt::format("       because {}\n", plan_.passes[i].reason);
            if (const auto dropped = writes(plan_.passes[i], false); !dropped.empty())
                out += fmt::format("       not made, since nothing reads it: {}\n", joined(dropped, ", "));
        }
        if (!ms_.empty()) out += fmt::format("     {:<52}{:9.2f} ms\n", "together", total);
        out += fmt::format("\nculled\n");
        for (const auto& culled : plan_.culled)
            out += fmt::format("     {:<24} {}\n", graph_.passes[index(culled.pass)].name, culled.reason);
        if (plan_.culled.empty()) out += "     none\n";
        if (!graph_.absent.empty()) out += fmt::format("not asked for: {}\n", joined(graph_.absent, ", "));
        out += fmt::format("\ntextures: {} in {}\n", bytesText(plan_.textureBytes()), plan_.textures.size());
        for (const auto& texture : plan_.textures)
            out += fmt::format("     {:<8} {:>5}×{:<5} {:>10}  {}\n", info(texture.format).name, texture.size.x,
                texture.size.y, bytesText(texture.bytes()), joined(resources(texture), ", then "));
        return out + fmt::format("scene data: {}\n", joined(sceneData(), ", "));
    }

    std::string json() const {
        std::string out = fmt::format("{{\n  \"version\": {},\n  \"facts\": {{", kFormatVersion);
        std::vector<std::string> items;
        for (const auto& [name, value] : facts_) items.push_back(jsonText(name) + ": " + jsonText(value));
        out += joined(items, ", ") + "},\n  \"passes\": [\n";
        items.clear();
        for (std::size_t i = 0; i < plan_.passes.size(); ++i)
            items.push_back(jsonPass(pass(plan_.passes[i]), false, plan_.passes[i].reason,
                writes(plan_.passes[i], true), writes(plan_.passes[i], false), i));
        for (const auto& culled : plan_.culled)
            items.push_back(jsonPass(graph_.passes[index(culled.pass)], true, culled.reason,
                allWrites(graph_.passes[index(culled.pass)]), {}, 0));
        out += joined(items, ",\n") + "\n  ],\n  \"textures\": [\n";
        items.clear();
        for (const auto& texture : plan_.textures)
            items.push_back(
                fmt::format("    {{\"format\": {}, \"width\": {}, \"height\": {}, \"bytes\": {}, \"holds\": {}}}",
                    jsonText(info(texture.format).name), texture.size.x, texture.size.y, texture.bytes(),
                    jsonList(resources(texture))));
        return out + joined(items, ",\n")
            + fmt::format("\n  ],\n  \"texture_bytes\": {},\n  \"scene_data\": {},\n  \"not_asked_for\": {}\n}}\n",
                plan_.textureBytes(), jsonList(sceneData()), jsonList(graph_.absent));
    }

    std::string dot() const {
        std::string out = "digraph plan {\n  rankdir = LR;\n  node [shape = box];\n";
        for (std::size_t i = 0; i < plan_.passes.size(); ++i) {
            const Pass& p = pass(plan_.passes[i]);
            const std::string time = ms_.empty() ? "" : fmt::format("\\n{:.2f} ms", ms_[i]);
            out +=
                fmt::format("  {} [label = \"{}\\n{} {}{}\"];\n", jsonText(p.name), p.name, p.slot, p.technique, time);
            for (const auto& read : p.reads)
                for (const auto& planned : plan_.passes)
                    for (const auto& write : pass(planned).writes)
                        if (write.resource == read.resource)
                            out += fmt::format("  {} -> {} [label = {}];\n", jsonText(pass(planned).name),
                                jsonText(p.name), jsonText(name(read.resource)));
        }
        for (const auto& culled : plan_.culled)
            out += fmt::format("  {} [style = dashed, color = grey, fontcolor = grey, tooltip = {}];\n",
                jsonText(graph_.passes[index(culled.pass)].name), jsonText(culled.reason));
        return out + "}\n";
    }

private:
    static std::size_t index(int i) { return static_cast<std::size_t>(i); }
    const Pass& pass(const PlannedPass& planned) const { return graph_.passes[index(planned.pass)]; }
    const std::string& name(ResourceId id) const { return graph_.resources[index(id.index)].name; }

    std::vector<std::string> reads(const Pass& p) const {
        std::vector<std::string> names;
        for (const auto& read : p.reads) names.push_back(name(read.resource));
        return names;
    }
    std::vector<std::string> writes(const PlannedPass& planned, bool made) const {
        std::vector<std::string> names;
        for (std::size_t w = 0; w < planned.writes.size(); ++w)
            if (planned.writes[w] == made) names.push_back(name(pass(planned).writes[w].resource));
        return names;
    }
    std::vector<std::string> allWrites(const Pass& p) const {
        std::vector<std::string> names;
        for (const auto& write : p.writes) names.push_back(name(write.resource));
        return names;
    }
    std::vector<std::string> resources(const PhysicalTexture& texture) const {
        std::vector<std::string> names;
        for (const int r : texture.resources) names.push_back(graph_.resources[index(r)].name);
        return names;
    }
    std::vector<std::string> sceneData() const {
        constexpr std::pair<SceneData, const char*> all[] = {{SceneData::positions, "positions"},
            {SceneData::normals, "normals"}, {SceneData::uvs, "uvs"}, {SceneData::colors, "vertex colours"},
            {SceneData::materials, "materials"}, {SceneData::lights, "lights"}, {SceneData::textures, "textures"},
            {SceneData::unifiedVertices, "one index for all attributes"}, {SceneData::rays, "ray tracing tree"},
            {SceneData::triangles, "triangles and their edges on the CPU"}, {SceneData::marks, "the scene's own lines"},
            {SceneData::coincidence, "which coincident faces are visible"},
            {SceneData::previous, "places in the frame before"}};
        std::vector<std::string> names;
        for (const auto& [flag, text] : all)
            if (has(plan_.sceneData, flag)) names.emplace_back(text);
        return names;
    }
    std::string rate(const Pass& p) const {
        if (p.rate == kEverySample) return "every sample";
        return p.rate == 1 ? "once per frame" : fmt::format("{} of {} samples", p.rate, graph_.samples);
    }
    std::vector<std::string> remarks(const Pass& p) const {
        std::vector<std::string> all{rate(p)};
        if (p.kind == Pass::Kind::host) all.emplace_back("on the CPU");
        if (!p.note.empty()) all.push_back(p.note);
        return all;
    }
    std::string jsonPass(const Pass& p, bool culled, const std::string& reason, const std::vector<std::string>& written,
        const std::vector<std::string>& dropped, std::size_t i) const {
        return fmt::format(
            "    {{\"name\": {}, \"slot\": {}, \"technique\": {}, \"culled\": {}, \"reason\": {}, \"reads\": {}, "
            "\"writes\": {}, \"not_made\": {}, \"runs\": {}, \"note\": {}{}}}",
            jsonText(p.name), jsonText(p.slot), jsonText(p.technique), culled, jsonText(reason), jsonList(reads(p)),
            jsonList(written), jsonList(dropped), jsonText(rate(p)), jsonText(p.note),
            culled || ms_.empty() ? "" : fmt::format(", \"milliseconds\": {:.3f}", ms_[i]));
    }

    const Graph& graph_;
    const Plan& plan_;
    const PlanFacts& facts_;
    std::span<const double> ms_;
};

}  // namespace

std::string explain(const Graph& graph, const Plan& plan, PlanFormat format, const PlanFacts& facts,
    std::span<const double> milliseconds) {
    const Explainer explainer(graph, plan, facts, milliseconds);
    switch (format) {
        case PlanFormat::text: return explainer.text();
        case PlanFormat::json: return explainer.json();
        case PlanFormat::dot: return explainer.dot();
    }
    return {};
}

}  // namespace limn
