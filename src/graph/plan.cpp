#include "graph/graph.h"

#include <fmt/format.h>

#include <algorithm>

namespace limn {
namespace {

/// Walks back from the wanted images and adds halos up. Per-sample passes shrink to what this run reads; passes with a
/// rate keep their extent.
void spreadDemand(const Graph& graph, Plan& plan, std::span<const Wanted> wanted) {
    struct Demand {
        bool isRead = false, whole = false;
        int halo = 0;
    };
    std::vector<Demand> demand(graph.resources.size());
    const auto of = [&](ResourceId id) -> Demand& { return demand[static_cast<std::size_t>(id.index)]; };
    for (const auto& want : wanted) {
        of(want.resource).isRead = true;
        of(want.resource).halo = std::max(of(want.resource).halo, want.halo);
    }
    for (auto planned = plan.passes.rbegin(); planned != plan.passes.rend(); ++planned) {
        const Pass& pass = graph.passes[static_cast<std::size_t>(planned->pass)];
        const bool isPerSample = pass.rate == kEverySample;
        if (isPerSample) {
            planned->halo = 0;
            planned->whole = false;
            planned->runs = false;
        }
        for (std::size_t w = 0; w < pass.writes.size(); ++w) {
            const Demand& written = of(pass.writes[w].resource);
            if (isPerSample && !written.isRead
                && graph.resources[static_cast<std::size_t>(pass.writes[w].resource.index)].format != Format::depth32f)
                planned->writes[w] = false;
            if (isPerSample) planned->runs = planned->runs || written.isRead;
            planned->halo = std::max(planned->halo, written.halo);
            planned->whole = planned->whole || written.whole;
        }
        // Even, so that images of half the size have the picture's pixels in the same places.
        planned->halo = (planned->halo + 1) / 2 * 2;
        if (!planned->runs) continue;
        for (const auto& read : pass.reads) {
            Demand& needed = of(read.resource);
            needed.isRead = true;
            needed.halo = std::max(needed.halo, planned->halo + read.halo);
            needed.whole = needed.whole || read.whole || planned->whole;
        }
    }
}

class Compiler {
public:
    Compiler(const Graph& graph, std::span<const Wanted> wanted) : graph_(graph), wanted_(wanted) {}

    Plan compile() {
        findWriters();
        state_.assign(graph_.passes.size(), State::unseen);
        reason_.resize(graph_.passes.size());
        live_.assign(graph_.resources.size(), false);
        for (const auto& want : wanted_) need(want.resource, fmt::format("asked for: {}", want.name));
        errors_.throwIfAny();
        collectPasses();
        spreadDemand(graph_, plan_, wanted_);
        layOutTextures();
        return std::move(plan_);
    }

private:
    enum class State { unseen, open, done };

    void fail(std::string problem) { errors_.add({ExitCode::internal, {}, std::move(problem), "please report this"}); }

    void findWriters() {
        writer_.assign(graph_.resources.size(), -1);
        for (std::size_t p = 0; p < graph_.passes.size(); ++p) {
            for (const auto& write : graph_.passes[p].writes) {
                int& writer = writer_[index(write.resource)];
                if (writer >= 0)
                    fail(fmt::format("'{}' is written by {} and by {}", graph_.resources[index(write.resource)].name,
                        graph_.passes[static_cast<std::size_t>(writer)].name, graph_.passes[p].name));
                writer = static_cast<int>(p);
            }
        }
    }

    void need(ResourceId resource, const std::string& reason) {
        const std::string& name = graph_.resources[index(resource)].name;
        live_[index(resource)] = true;
        const int writer = writer_[index(resource)];
        if (writer < 0) return fail(fmt::format("{}, but nothing writes '{}'", reason, name));
        const auto p = static_cast<std::size_t>(writer);
        if (state_[p] == State::done) return;
        const Pass& pass = graph_.passes[p];
        if (state_[p] == State::open) return fail(fmt::format("{} needs its own result '{}'", pass.name, name));
        state_[p] = State::open;
        reason_[p] = reason;
        for (const auto& read : pass.reads)
            need(read.resource, fmt::format("{} reads {}", pass.name, graph_.resources[index(read.resource)].name));
        state_[p] = State::done;
    }

    void collectPasses() {
        // Passes are declared after the passes they read, so that the order of declaration is an order of execution.
        for (std::size_t p = 0; p < graph_.passes.size(); ++p) {
            const Pass& pass = graph_.passes[p];
            if (state_[p] != State::done) {
                std::string names;
                for (const auto& write : pass.writes)
                    names += (names.empty() ? "" : ", ") + graph_.resources[index(write.resource)].name;
                plan_.culled.push_back({static_cast<int>(p), "nothing reads " + names});
                continue;
            }
            PlannedPass planned{static_cast<int>(p), {}, reason_[p]};
            plan_.sceneData = plan_.sceneData | pass.needs;
            for (const auto& write : pass.writes) {
                // A depth buffer serves its own pass even if nobody reads it afterwards.
                const bool isOwnDepth = pass.kind == Pass::Kind::raster
                    && graph_.resources[index(write.resource)].format == Format::depth32f;
                if (isOwnDepth) live_[index(write.resource)] = true;
                planned.writes.push_back(live_[index(write.resource)]);
                if (planned.writes.back()) plan_.sceneData = plan_.sceneData | write.needs;
            }
            plan_.passes.push_back(std::move(planned));
        }
    }

    void layOutTextures() {
        constexpr int kForever = 1 << 30;
        std::vector<int> lastUse(graph_.resources.size(), -1);
        // An image outlives a run if a reader may run in a sample without its writer.
        const auto makesFor = [](int writer, int reader) { return writer == reader || writer == kEverySample; };
        std::vector<int> rateOf(graph_.resources.size(), kEverySample);
        std::vector<bool> mustLast(graph_.resources.size(), false);
        for (std::size_t i = 0; i < plan_.passes.size(); ++i) {
            const Pass& pass = graph_.passes[static_cast<std::size_t>(plan_.passes[i].pass)];
            for (const auto& read : pass.reads) {
                lastUse[index(read.resource)] = static_cast<int>(i);
                mustLast[index(read.resource)] =
                    mustLast[index(read.resource)] || !makesFor(rateOf[index(read.resource)], pass.rate);
            }
            for (const auto& write : pass.writes) rateOf[index(write.resource)] = pass.rate;
            for (const auto& write : pass.writes)
                lastUse[index(write.resource)] = std::max(lastUse[index(write.resource)], static_cast<int>(i));
        }
        for (const auto& want : wanted_) {
            lastUse[index(want.resource)] = kForever;
            mustLast[index(want.resource)] = rateOf[index(want.resource)] != kEverySample;
        }

        plan_.textureOf.assign(graph_.resources.size(), -1);
        std::vector<int> busyUntil;
        for (std::size_t i = 0; i < plan_.passes.size(); ++i) {
            const Pass& pass = graph_.passes[static_cast<std::size_t>(plan_.passes[i].pass)];
            for (std::size_t w = 0; w < pass.writes.size(); ++w) {
                if (!plan_.passes[i].writes[w]) continue;
                const std::size_t r = index(pass.writes[w].resource);
                const Resource& resource = graph_.resources[r];
                const bool persistent = resource.persistent || mustLast[r];
                std::size_t place = 0;
                for (; place < plan_.textures.size(); ++place) {
                    const auto& texture = plan_.textures[place];
                    if (!persistent && !texture.persistent && texture.format == resource.format
                        && texture.size == resource.size && busyUntil[place] < static_cast<int>(i))
                        break;
                }
                if (place == plan_.textures.size()) {
                    plan_.textures.push_back({resource.format, resource.size, persistent, {}});
                    busyUntil.push_back(0);
                }
                plan_.textures[place].resources.push_back(static_cast<int>(r));
                plan_.textureOf[r] = static_cast<int>(place);
                busyUntil[place] = persistent ? kForever : lastUse[r];
            }
        }
    }

    static std::size_t index(ResourceId id) { return static_cast<std::size_t>(id.index); }

    const Graph& graph_;
    std::span<const Wanted> wanted_;
    ErrorCollector errors_;
    Plan plan_;
    std::vector<int> writer_;
    std::vector<State> state_;
    std::vector<std::string> reason_;
    std::vector<bool> live_;
};

}  // namespace

int Plan::halo() const {
    int widest = 0;
    for (const auto& planned : passes) widest = std::max(widest, planned.halo);
    return widest;
}

std::uint64_t Plan::textureBytes() const {
    std::uint64_t bytes = 0;
    for (const auto& texture : textures) bytes += texture.bytes();
    return bytes;
}

Plan narrow(
    const Graph& graph, Plan plan, std::span<const Wanted> wanted, const std::function<bool(const Pass&)>& isDue) {
    for (auto& planned : plan.passes) planned.runs = isDue(graph.passes[static_cast<std::size_t>(planned.pass)]);
    spreadDemand(graph, plan, wanted);
    return plan;
}

Plan compile(const Graph& graph, std::span<const Wanted> wanted) { return Compiler(graph, wanted).compile(); }

}  // namespace limn
