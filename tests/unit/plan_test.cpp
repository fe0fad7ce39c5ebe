#include "graph/graph.h"

#include <gtest/gtest.h>

namespace limn {
namespace {

struct Builder {
    Graph graph;
    ResourceId image(const char* name, Format format = Format::r32f, bool persistent = false) {
        return graph.add({name, format, {64, 32}, persistent});
    }
    void pass(const char* name, std::vector<ResourceId> reads, std::vector<ResourceId> writes) {
        Pass p;
        p.name = name;
        for (const auto r : reads) p.reads.push_back({"r", r});
        for (const auto w : writes) p.writes.push_back({"w", w});
        graph.passes.push_back(p);
    }
    std::vector<std::string> names(const Plan& plan) const {
        std::vector<std::string> list;
        for (const auto& planned : plan.passes)
            list.push_back(graph.passes[static_cast<std::size_t>(planned.pass)].name);
        return list;
    }
};

TEST(Plan, whatNobodyNeedsDoesNotRun) {
    Builder b;
    const auto depth = b.image("depth"), normal = b.image("normal"), ao = b.image("ao"), beauty = b.image("beauty");
    b.pass("geometry", {}, {depth, normal});
    b.pass("ao", {depth, normal}, {ao});
    b.pass("shade", {depth}, {beauty});
    const Wanted wanted[] = {{"beauty", beauty}};
    const Plan plan = compile(b.graph, wanted);
    EXPECT_EQ(b.names(plan), (std::vector<std::string>{"geometry", "shade"}));
    ASSERT_EQ(plan.culled.size(), 1u);
    EXPECT_EQ(plan.culled[0].reason, "nothing reads ao");
    EXPECT_EQ(plan.passes[0].writes, (std::vector<bool>{true, false})) << "the normal is not even attached";
    EXPECT_FALSE(plan.makes(normal));
    EXPECT_EQ(plan.textureBytes(), 2u * 64 * 32 * 4);
}

TEST(Plan, texturesAreSharedOnceTheirLivesAreOver) {
    Builder b;
    const auto a = b.image("a"), c = b.image("c"), d = b.image("d"), e = b.image("e");
    b.pass("1", {}, {a});
    b.pass("2", {a}, {c});
    b.pass("3", {c}, {d});
    b.pass("4", {d}, {e});
    const Wanted wanted[] = {{"e", e}};
    const Plan plan = compile(b.graph, wanted);
    EXPECT_EQ(plan.textures.size(), 2u);
    EXPECT_EQ(plan.textureOf[0], plan.textureOf[2]);
    EXPECT_NE(plan.textureOf[0], plan.textureOf[1]) << "never read and written by one pass";
}

TEST(Plan, wantedAndPersistentTexturesAreNeverShared) {
    Builder b;
    const auto a = b.image("a"), sum = b.image("sum", Format::r32f, true), c = b.image("c");
    b.pass("1", {}, {a});
    b.pass("2", {a}, {sum});
    b.pass("3", {}, {c});
    const Wanted wanted[] = {{"sum", sum}, {"a", a}, {"c", c}};
    const Plan plan = compile(b.graph, wanted);
    EXPECT_EQ(plan.textures.size(), 3u);
}

TEST(Plan, aRunMakesWhatItsOwnPassesRead) {
    Builder b;
    const auto ids = b.image("ids"), depth = b.image("depth"), normal = b.image("normal"), lines = b.image("lines"),
               beauty = b.image("beauty");
    b.pass("raster", {}, {ids});
    b.pass("resolve", {ids}, {depth, normal});
    b.pass("lines", {depth, normal}, {lines});
    b.pass("shade", {depth, lines}, {beauty});
    b.graph.passes[0].rate = 2;
    b.graph.passes[2].rate = 4;
    b.graph.passes[2].reads[0].halo = 6;
    const Wanted wanted[] = {{"beauty", beauty}};
    const Plan plan = compile(b.graph, wanted);
    EXPECT_EQ(plan.passes[1].halo, 6);
    const auto run = [&](bool first, bool findsLines) {
        return narrow(b.graph, plan, wanted, [&](const Pass& pass) {
            return pass.rate == 4 ? findsLines : pass.rate == 2 ? first : true;
        });
    };
    const Plan all = run(true, true);
    for (std::size_t i = 0; i < plan.passes.size(); ++i) {
        EXPECT_TRUE(all.passes[i].runs);
        EXPECT_EQ(all.passes[i].halo, plan.passes[i].halo);
        EXPECT_EQ(all.passes[i].writes, plan.passes[i].writes);
    }
    const Plan plain = run(false, false);
    EXPECT_FALSE(plain.passes[0].runs);
    EXPECT_FALSE(plain.passes[2].runs);
    EXPECT_EQ(plain.passes[1].writes, (std::vector<bool>{true, false})) << "only lines read the normal";
    EXPECT_EQ(plain.passes[1].halo, 0);
    EXPECT_EQ(plain.textureOf, plan.textureOf);
    const Plan begins = run(true, false);
    EXPECT_EQ(begins.passes[0].halo, 6) << "triangle ids serve later samples, which find lines";
}

TEST(Plan, allErrorsAtOnce) {
    Builder b;
    const auto a = b.image("a"), c = b.image("c"), d = b.image("d"), lost = b.image("lost");
    b.pass("1", {c}, {a});
    b.pass("2", {a}, {c});
    b.pass("3", {lost}, {d});
    b.pass("4", {}, {d});
    const Wanted wanted[] = {{"a", a}, {"d", d}};
    try {
        compile(b.graph, wanted);
        FAIL();
    } catch (const Errors& errors) {
        std::string all;
        for (const auto& error : errors.list) all += error.message + "\n";
        EXPECT_NE(all.find("'d' is written by 3 and by 4"), std::string::npos) << all;
        EXPECT_NE(all.find("needs its own result"), std::string::npos) << all;
    }
}

TEST(Plan, explanationsAreWellFormed) {
    Builder b;
    const auto a = b.image("a"), c = b.image("c");
    b.pass("one", {}, {a});
    b.pass("two", {}, {c});
    const Wanted wanted[] = {{"a", a}};
    const Plan plan = compile(b.graph, wanted);
    const std::string json = explain(b.graph, plan, PlanFormat::json, {{"config", "a \"quoted\" name"}});
    EXPECT_NE(json.find("\"culled\": true"), std::string::npos);
    EXPECT_NE(json.find("a \\\"quoted\\\" name"), std::string::npos);
    EXPECT_NE(explain(b.graph, plan, PlanFormat::text, {}).find("nothing reads c"), std::string::npos);
    EXPECT_NE(explain(b.graph, plan, PlanFormat::dot, {}).find("digraph"), std::string::npos);
}

}  // namespace
}  // namespace limn
