#include "base/in_order.h"
#include "base/text.h"
#include "settings/color.h"
#include "settings/document.h"
#include "settings/fields.h"
#include "settings/uniform_block.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <thread>

namespace limn {
enum class Fruit { apple, pear };
template <>
inline constexpr std::array<std::string_view, 2> enumNames<Fruit> = {"apple", "pear"};

namespace {

struct Basket {
    float weight = 1.5f;
    int count = 3;
    bool ripe = true;
    Fruit fruit = Fruit::pear;
    Color color{1, 1, 1};
    Length reach = Length::percent(5);
    PictureLength line = PictureLength::pixels(2);
    glm::dvec3 place{0};
};
constexpr Field kBasket[] = {
    field<&Basket::weight>("weight", {.unit = "kg", .min = 0, .max = 10}, "How heavy."),
    field<&Basket::count>("count", {.min = 0, .max = 100}, "How many."),
    field<&Basket::ripe>("ripe", "Ready."),
    field<&Basket::fruit>("fruit", "Which."),
    field<&Basket::color>("color", "Colour."),
    field<&Basket::reach>("reach", {.min = 0}, "How far."),
    field<&Basket::line>("line", {.min = 0}, "How wide."),
    field<&Basket::place>("place", "Where."),
};

struct Read {
    Basket basket;
    std::vector<Track> tracks;
    ErrorCollector errors;
};
Read read(const std::string& toml) {
    Read result;
    readFields(parseDocument(toml, "basket.toml"), kBasket, &result.basket, &result.tracks, "[basket]", result.errors);
    return result;
}
std::string onlyError(const std::string& toml) {
    const Read result = read(toml);
    EXPECT_EQ(result.errors.list().size(), 1u) << toml;
    return result.errors.empty() ? "" : result.errors.list().front().message;
}

TEST(Params, readsEveryType) {
    const Read r = read(
        "weight = 2.5\ncount = 7\nripe = false\nfruit = 'apple'\ncolor = '#ff0000'\nreach = 0.25\nline = "
        "'0.35mm'\nplace = [1, 2.5, -3]");
    EXPECT_TRUE(r.errors.empty());
    EXPECT_EQ(r.basket.weight, 2.5f);
    EXPECT_EQ(r.basket.count, 7);
    EXPECT_FALSE(r.basket.ripe);
    EXPECT_EQ(r.basket.fruit, Fruit::apple);
    EXPECT_EQ(r.basket.color, (Color{1, 0, 0}));
    EXPECT_EQ(r.basket.reach, Length::units(0.25));
    EXPECT_NEAR(r.basket.line.inPixels(1000, 254), 3.5, 1e-12);  // 0.35 mm at 10 pixels a millimetre
    EXPECT_EQ(r.basket.place, glm::dvec3(1, 2.5, -3));
}

TEST(Params, whatIsWrittenReadsBackTheSame) {
    Basket basket{0.1f, 4, false, Fruit::apple, {0.25f, 0.5f, 1}, Length::percent(7.5),
        {0.002, PictureLength::Unit::imageHeight}, {0.1, 1e-9, 3}};
    std::string toml;
    for (const auto& f : kBasket) toml += std::string(f.name) + " = " + f.type().text(f.member(&basket)) + "\n";
    const Read r = read(toml);
    EXPECT_TRUE(r.errors.empty()) << toml;
    for (const auto& f : kBasket)
        EXPECT_EQ(f.type().text(f.constMember(&r.basket)), f.type().text(f.member(&basket))) << f.name;
}

TEST(Params, errorsNamePlaceProblemAndRemedy) {
    EXPECT_EQ(onlyError("wieght = 2"), "basket.toml:1:1: unknown key 'wieght' in [basket]; did you mean 'weight'?");
    EXPECT_NE(onlyError("\nweight = 11").find("basket.toml:2:10: 'weight' in [basket] is 11, but must be 0 to 10"),
        std::string::npos);
    EXPECT_NE(onlyError("count = 2.5").find("must be a whole number"), std::string::npos);
    EXPECT_NE(onlyError("fruit = 'aple'").find("did you mean 'apple'?"), std::string::npos);
    EXPECT_NE(onlyError("color = 'red'").find("#rrggbb"), std::string::npos);
    EXPECT_NE(onlyError("reach = '5 miles'").find("must be a length"), std::string::npos);
    EXPECT_NE(onlyError("weight = nan").find("finite"), std::string::npos);
    EXPECT_EQ(read("weight = 11\ncount = -1\nbogus = 1").errors.list().size(), 3u);  // all at once
}

TEST(Params, keyedValues) {
    const Read r = read(
        "weight = { keys = [[1, 2], [11, 4]] }\nplace = { keys = [[1, [0,0,0]], [3, [2,0,8]]], interpolation = "
        "'constant' }\ncount = { keys = [[0, 0], [2, 3]] }");
    ASSERT_TRUE(r.errors.empty());
    Basket at = r.basket;
    applyTracks(&at, r.tracks, 6);
    EXPECT_EQ(at.weight, 3);
    applyTracks(&at, r.tracks, -5);
    EXPECT_EQ(at.weight, 2) << "held before the first key";
    applyTracks(&at, r.tracks, 99);
    EXPECT_EQ(at.weight, 4) << "held after the last key";
    applyTracks(&at, r.tracks, 2.9);
    EXPECT_EQ(at.place, glm::dvec3(0)) << "constant holds until the next key";
    applyTracks(&at, r.tracks, 1);
    EXPECT_EQ(at.count, 2) << "integers round";
    EXPECT_NE(onlyError("fruit = { keys = [[1, 'apple']] }").find("cannot be keyed"), std::string::npos);
    EXPECT_NE(onlyError("weight = { keys = [[1, 99]] }").find("0 to 10"), std::string::npos);
}

struct Constants {
    float a = 1;
    glm::vec3 b{2, 3, 4};
    float c = 5;
    bool d = true;
    glm::ivec2 e{6, 7};
    std::array<glm::vec4, 16> f{};
};
constexpr Field kConstants[] = {
    field<&Constants::a>("a", {.unit = "m"}, "First."),
    field<&Constants::b>("b", "Second."),
    field<&Constants::c>("c", "Third."),
    field<&Constants::d>("d", "Fourth."),
    field<&Constants::e>("e", "Fifth."),
    field<&Constants::f>("f", "Sixth."),
};

TEST(Params, uniformBlockFollowsStd140) {
    const Constants constants;
    const UniformBlock block = makeUniformBlock("params", 1, kConstants, &constants);
    const auto floatAt = [&](std::size_t at) {
        float v;
        std::memcpy(&v, block.bytes.data() + at, 4);
        return v;
    };
    const auto intAt = [&](std::size_t at) {
        int v;
        std::memcpy(&v, block.bytes.data() + at, 4);
        return v;
    };
    EXPECT_EQ(floatAt(0), 1);
    EXPECT_EQ(floatAt(16), 2) << "vec3 aligns to 16";
    EXPECT_EQ(floatAt(28), 5) << "a float fills the vec3's fourth place";
    EXPECT_EQ(intAt(32), 1) << "bool is an int";
    EXPECT_EQ(intAt(40), 6) << "ivec2 aligns to 8";
    EXPECT_EQ(block.bytes.size(), 48u + 16 * 16);
    EXPECT_NE(block.glsl().find("float a;  // m: First."), std::string::npos);
}

TEST(Params, constantsAreHandedOnWhereTheyAreUsed) {
    const Constants constants;
    UniformBlock block = makeUniformBlock("params", 1, kConstants, &constants);
    const HandedOn none = handOn(block, "float view_a = otherparams.a + params.ab;");
    EXPECT_EQ(none.vectors, 0);
    EXPECT_TRUE(none.fragment.empty());
    EXPECT_EQ(none.vertex, "void handOn_params() {\n}\n");

    appendVectors(block, "list", std::vector<glm::vec4>(3));
    const HandedOn some = handOn(block, "x = params.b.x + (params.d ? 1.0 : params.list[2].y);");
    EXPECT_EQ(some.vectors, 1 + 1 + 3);
    EXPECT_NE(some.vertex.find("flat out vec3 params_b;"), std::string::npos) << some.vertex;
    EXPECT_NE(some.vertex.find("params_d = int(paramsUniforms.d);"), std::string::npos) << some.vertex;
    EXPECT_NE(some.fragment.find("flat in vec4[3] params_list;"), std::string::npos) << some.fragment;
    EXPECT_NE(some.fragment.find("params = paramsConstants(params_b, params_d != 0, params_list);"), std::string::npos)
        << some.fragment;
    EXPECT_EQ(some.fragment.find("params_a"), std::string::npos) << "nobody reads it";
}

TEST(Text, nearestName) {
    const std::vector<std::string> names{"radius", "directions", "steps"};
    EXPECT_EQ(nearestName("raduis", names), "radius");
    EXPECT_EQ(nearestName("direction", names), "directions");
    EXPECT_EQ(nearestName("colour", names), std::nullopt);
}

TEST(InOrder, takesEverythingInOrderAndHandsOnWhatIsThrown) {
    constexpr std::size_t kCount = 2000;
    std::vector<std::size_t> made(kCount), taken;
    const auto caller = std::this_thread::get_id();
    inOrder(
        kCount, [&](std::size_t i) { made[i] = i * i; },
        [&](std::size_t i) {
            EXPECT_EQ(std::this_thread::get_id(), caller);
            EXPECT_EQ(made[i], i * i) << "made before it is taken";
            taken.push_back(i);
        });
    ASSERT_EQ(taken.size(), kCount);
    EXPECT_TRUE(std::is_sorted(taken.begin(), taken.end()));
    inOrder(
        0, [](std::size_t) { FAIL(); }, [](std::size_t) { FAIL(); });

    std::size_t before = 0;
    EXPECT_THROW(inOrder(
                     kCount,
                     [](std::size_t i) {
                         if (i == 700) throw std::runtime_error("make");
                     },
                     [&](std::size_t) { ++before; }),
        std::runtime_error);
    EXPECT_EQ(before, 700u);
    EXPECT_THROW(inOrder(
                     kCount, [](std::size_t) {},
                     [](std::size_t i) {
                         if (i == 700) throw std::runtime_error("take");
                     }),
        std::runtime_error);
}

TEST(Color, srgbRoundTrip) {
    for (int i = 0; i <= 255; ++i) EXPECT_NEAR(linearToSrgb(srgbToLinear(static_cast<float>(i) / 255)) * 255, i, 1e-3);
    EXPECT_EQ(hexColor(*parseHexColor("#d89c7a")), "#d89c7a");
    EXPECT_FALSE(parseHexColor("#12345"));
    EXPECT_FALSE(parseHexColor("#12345g"));
}

TEST(Document, settingsLayerOn) {
    Node d = parseDocument("[ao]\nradius = 1\n[[edges]]\nwidth = '1px'\n[[edges]]\nwidth = '2px'", "x.toml");
    applySetting(d, "ao.radius=0.4");
    applySetting(d, "edges.1.width=3px");
    applySetting(d, "image.size=[3, 4]");
    EXPECT_EQ(d.find("ao")->find("radius")->number(), 0.4);
    EXPECT_EQ(*d.find("edges")->array()[1].find("width")->text(), "3px");
    EXPECT_EQ(d.find("image")->find("size")->array()[1].number(), 4);
    EXPECT_THROW(applySetting(d, "edges.7.width=1"), Error);
    EXPECT_THROW(applySetting(d, "edges.width=1"), Error) << "which of the two?";
    EXPECT_THROW(applySetting(d, "nothing"), Error);
}

TEST(Document, lettersBeyondAsciiBelongIntoQuotes) {
    EXPECT_NO_THROW(
        parseDocument("# Zürich\na = \"Zürich \\\" ü\"\nb = 'é'\nc = \"\"\"ä\n\"ö\"\n\"\"\" # ß\nd = \"\"\n", "t"));
    const Node continued =
        parseDocument("a = \"\"\"x \\\n  étage\"\"\"", "t");  // a line's end that is left out, then a letter
    EXPECT_EQ(*continued.find("a")->text(), "x étage");
    for (const char* text :
        {"a = 1\nb = \"\"\"\\é\"\"\"\n", "a = 1\nb = \"\"\"\\\xC2\xA0\"\"\"\n", "a = \"\"\"\"\"\"\nb = é\n",
            "a = 1\nb = ä\n", "a = 1\n  ü = 1\n", "a = \"x\"\nb\xC2\xA0= 1\n", "a = 1\nb = \xFF\n"}) {
        const bool isText = std::string_view(text).find('\xFF') == std::string_view::npos;
        try {
            parseDocument(text, "t");
            FAIL() << text;
        } catch (const Error& error) {
            EXPECT_NE(error.message.find("t:2:"), std::string::npos) << error.message;
            EXPECT_NE(error.message.find(isText ? "belong into quotes" : "invalid utf-8"), std::string::npos)
                << error.message;
        }
    }
}

TEST(Document, canonicalTextIgnoresOrderAndPlace) {
    EXPECT_EQ(canonicalText(parseDocument("a = 1\nb = 'x'", "1")),
        canonicalText(parseDocument("b = 'x'\n\n# note\na = 1", "2")));
    EXPECT_NE(canonicalText(parseDocument("a = 1", "1")), canonicalText(parseDocument("a = 2", "1")));
}

}  // namespace
}  // namespace limn
