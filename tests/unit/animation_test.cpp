// Things over frames: curves against formulas and against Blender's own, rotations, parents, sequences of files.

#include "formats/scene_file.h"
#include "settings/document.h"
#include "stage/scene_at.h"

#include <fmt/format.h>
#include <gtest/gtest.h>
#include <glm/gtc/matrix_transform.hpp>

#include <cmath>

namespace limn {
namespace {

struct Thing {
    double number = 0;
    glm::dvec3 place{1, 2, 3};
    glm::dquat turn{1, 0, 0, 0};
    bool shown = true;
};
constexpr Field kThing[] = {
    field<&Thing::number>("number", {.min = -1000, .max = 1000}, "A number."),
    field<&Thing::place>("place", "A place."),
    field<&Thing::turn>("turn", "A rotation."),
    field<&Thing::shown>("shown", "Is it there?"),
};

Keyed<Thing> keyed(const std::string& toml) {
    Keyed<Thing> thing;
    ErrorCollector errors;
    readFields(parseDocument(toml, "test.toml"), kThing, &thing.base, &thing.tracks, "thing", errors);
    for (const auto& error : errors.list()) ADD_FAILURE() << toml << "\n" << error.message;
    return thing;
}

std::string problem(const std::string& toml) {
    Keyed<Thing> thing;
    ErrorCollector errors;
    readFields(parseDocument(toml, "test.toml"), kThing, &thing.base, &thing.tracks, "thing", errors);
    return errors.empty() ? "" : errors.list().front().message;
}

TEST(Animation, bezierCurvesAreBlenders) {
    // Made by Blender 3.4.1: F-curves with free handles, some beyond the next keyframe, and FCurve.evaluate().
    struct Curve {
        const char* keys;
        std::vector<double> values;
    };
    const double frames[] = {1.5, 3, 4.25, 6.9, 7.5, 8.1, 10, 13, 16, 19.5};
    const Curve curves[] = {
        {"[1, 0.737, [-5.659, 4.116], [1.261, 0.462]], [7, 1.451, [-1.49, 2.643], [15.108, -1.643]], "
         "[8.5, 1.771, [4.278, -0.256], [13.394, 2.363]], [20, 2.655, [19.882, 0.389], [22.515, 5.986]]",
            {1.114391, 1.602992, 1.674337, 1.464873, 1.239524, 1.549616, 1.878194, 1.802463, 1.587753, 1.872512}},
        {"[1, 1.594, [-4.557, -1.392], [1.016, 4.565]], [7, -2.042, [5.115, -4.318], [15.842, 0.9369999]], "
         "[8.5, 1.783, [5.896, 5.475], [13.353, 3.206]], [20, -2.167, [18.157, 1.361], [26.216, 1.566]]",
            {2.105013, 0.4103651, -1.078837, -2.150431, -1.506211, 2.230474, 2.12125, 2.202395, 1.419626, -1.350128}},
        {"[1, 2.362, [-0.311, -1.117], [3.712, 3.187]], [7, -1.207, [6.97, 0.216], [10.041, -2.727]], "
         "[8.5, -0.833, [1.133, -0.987], [11.342, -0.983]], [20, -2.004, [13.658, -5.548], [28.776, -5.821]]",
            {2.471601, 2.372628, 1.885164, -0.744468, -1.432409, -0.8795063, -1.265296, -2.829416, -3.33256, -2.27104}},
    };
    for (const auto& curve : curves) {
        const auto thing = keyed(fmt::format("number = {{ keys = [{}], interpolation = 'bezier' }}", curve.keys));
        for (std::size_t i = 0; i < std::size(frames); ++i)
            EXPECT_NEAR(thing.at(frames[i]).number, curve.values[i], 2e-5)
                << "Blender reckons in floats; " << frames[i];
    }
}

TEST(Animation, handlesOnALineMakeALine) {
    const auto thing = keyed(
        "place = { keys = [[1, [0,0,0], [1, [0,0,0]], [5, [4,8,0]]], [13, [12,24,0], [9, [8,16,0]], [13, [12,24,0]]]], "
        "interpolation = 'bezier' }");
    for (double frame = 1; frame <= 13; frame += 0.37) {
        EXPECT_NEAR(thing.at(frame).place.x, frame - 1, 1e-12);
        EXPECT_NEAR(thing.at(frame).place.y, 2 * (frame - 1), 1e-12);
    }
}

TEST(Animation, splinesGoThroughTheirKeysWithoutCorners) {
    // A parabola is its own spline, but for the first and last stretch, whatever the distances of the keys.
    std::string keys;
    for (const double frame : {0.0, 1.0, 3.0, 4.5, 8.0, 9.0})
        keys += fmt::format("{}[{}, {}]", keys.empty() ? "" : ", ", frame, frame * frame);
    for (const char* kind : {"spline", "bezier"}) {  // handles that nobody gives are the spline's
        const auto thing = keyed(fmt::format("number = {{ keys = [{}], interpolation = '{}' }}", keys, kind));
        for (double frame = 1; frame <= 8; frame += 0.23) EXPECT_NEAR(thing.at(frame).number, frame * frame, 1e-9);
    }
}

TEST(Animation, curvesGoOnBeyondTheirEnds) {
    const auto at = [](const char* beyond, double frame) {
        return keyed(fmt::format("number = {{ keys = [[0, 0], [4, 8], [10, 2]], beyond = '{}' }}", beyond))
            .at(frame)
            .number;
    };
    for (double frame = 0; frame <= 10; frame += 0.7) {
        const double inside = at("hold", frame);
        EXPECT_NEAR(at("repeat", frame + 30), inside, 1e-9);
        EXPECT_NEAR(at("repeat", frame - 20), inside, 1e-9);
        EXPECT_NEAR(at("offset", frame + 30), inside + 6, 1e-9);
        EXPECT_NEAR(at("offset", frame - 20), inside - 4, 1e-9);
        EXPECT_NEAR(at("mirror", 20 - frame), inside, 1e-9);
        EXPECT_NEAR(at("mirror", -frame), inside, 1e-9);
        EXPECT_NEAR(at("mirror", frame + 40), inside, 1e-9);
    }
    EXPECT_EQ(at("hold", 12), 2);
    EXPECT_EQ(at("linear", 12), 0);
    EXPECT_EQ(at("linear", -3), -6);
}

TEST(Animation, numbersOfAVectorHaveCurvesOfTheirOwn) {
    const auto thing = keyed(
        "place = { x = { keys = [[1, 0], [11, 10]] }, z = { keys = [[1, 5], [3, 7]], interpolation = 'constant', "
        "beyond = 'repeat' } }");
    const glm::dvec3 there = thing.at(6).place;
    EXPECT_EQ(there, glm::dvec3(5, 2, 5)) << "y stays what it is";
    EXPECT_EQ(keyed("place = { y = 9 }").at(1).place, glm::dvec3(1, 9, 3));
}

TEST(Animation, rotationsTakeTheShortestWayAtEvenSpeed) {
    // From 170 to -170 degrees about y: 20 degrees through 180, not 340 back. The second is written with the other
    // sign.
    const auto quaternion = [](double degrees, double sign) {
        const glm::dquat q = glm::angleAxis(glm::radians(degrees), glm::dvec3(0, 1, 0));
        return fmt::format("[{}, {}, {}, {}]", sign * q.w, sign * q.x, sign * q.y, sign * q.z);
    };
    for (const double sign : {1.0, -1.0}) {
        const auto thing =
            keyed(fmt::format("turn = {{ keys = [[0, {}], [20, {}]] }}", quaternion(170, 1), quaternion(-170, sign)));
        for (double frame = 0; frame <= 20; frame += 1) {
            const glm::dquat found = thing.at(frame).turn,
                             wanted = glm::angleAxis(glm::radians(170 + frame), glm::dvec3(0, 1, 0));
            EXPECT_NEAR(std::abs(glm::dot(found, wanted)), 1, 1e-12) << frame;
        }
    }
}

TEST(Animation, visibilityIsConstantBetweenKeys) {
    const auto thing = keyed("shown = { keys = [[1, true], [5, false], [9, true]] }");
    for (const auto& [frame, shown] : {std::pair(1.0, true), {4.9, true}, {5.0, false}, {8.99, false}, {9.0, true}})
        EXPECT_EQ(thing.at(frame).shown, shown) << frame;
}

TEST(Animation, badCurvesAreNamed) {
    const std::pair<const char*, const char*> cases[] = {
        {"number = { keys = [[1, 2, [0, 1], [2, 1]]] }", "they belong to interpolation = \"bezier\""},
        {"number = { keys = [[1, 2, [3, 1], [2, 1]]], interpolation = 'bezier' }", "on the wrong side"},
        {"number = { keys = [[1, 2, [0, 1], [2, 1]], [4, 2]], interpolation = 'bezier' }", "at some keys only"},
        {"number = { keys = [[1, 2]], beyond = 'repaet' }", "did you mean 'repeat'?"},
        {"number = { keys = [[1, 2]], interpolation = 'beziér' }", "did you mean 'bezier'?"},
        {"place = { x = 'far' }", "has no number for 'x'"},
        {"place = { x = { keys = [[1, [1, 2]]] } }", "value is no number"},
        {"turn = [0, 0, 0, 0]", "has no length"},
        {"number = { x = { keys = [[1, 2]] } }", "unknown entry 'x'"},
    };
    for (const auto& [toml, words] : cases) EXPECT_NE(problem(toml).find(words), std::string::npos) << problem(toml);
}

TEST(Animation, filesOfASequence) {
    const auto files = [](const SequenceSettings& settings) {
        std::string list;
        for (int frame = -1; frame <= 9; ++frame) list += fmt::format("{} ", settings.fileAt(frame));
        return list;
    };
    EXPECT_EQ(files({true, 3, 5, 1, 1, SequenceEnds::hold}), "3 3 3 4 5 5 5 5 5 5 5 ");
    EXPECT_EQ(files({true, 3, 5, 1, 1, SequenceEnds::loop}), "4 5 3 4 5 3 4 5 3 4 5 ");
    EXPECT_EQ(files({true, 3, 5, 1, 1, SequenceEnds::bounce}), "5 4 3 4 5 4 3 4 5 4 3 ");
    EXPECT_EQ(files({true, 3, 5, 0, 0.5, SequenceEnds::loop}), "5 3 3 4 4 5 5 3 3 4 4 ");
    EXPECT_EQ(files({true, 3, 5, 4, 2, SequenceEnds::hold}), "3 3 3 3 3 3 5 5 5 5 5 ");
    EXPECT_EQ(files({true, 7, 7, 4, 2, SequenceEnds::bounce}), "7 7 7 7 7 7 7 7 7 7 7 ");
}

const std::string kMesh = "[[mesh]]\nname = 'm'\nfile = '" LIMN_SOURCE_DIR "/scenes/solids/meshes/die.obj'\n";

TEST(Animation, thingsMoveWithTheirParents) {
    const Scene scene = parseScene(parseDocument(kMesh + R"(
        [[node]]
        name = 'car'
        translate = { keys = [[0, [0, 0, 0]], [10, [20, 0, 0]]] }
        [[node]]
        name = 'axle'
        parent = 'car'
        translate = [1, 0.5, 0]
        rotate = { keys = [[0, [0, 0, 0]], [10, [0, 0, -900]]] }
        [[instance]]
        mesh = 'm'
        name = 'valve'
        parent = 'axle'
        translate = [0.25, 0, 0]
    )",
                                       "scene.toml"),
        "scene.toml");
    for (const double frame : {0.0, 1.0, 2.5, 10.0}) {
        const glm::dmat4 world = scene.worldFrom("valve", frame);
        const double turn = glm::radians(-90 * frame);
        EXPECT_NEAR(world[3].x, 2 * frame + 1 + 0.25 * std::cos(turn), 1e-12);
        EXPECT_NEAR(world[3].y, 0.5 + 0.25 * std::sin(turn), 1e-12);
    }
}

TEST(Animation, badParentsAreNamed) {
    const auto problemOf = [](const std::string& toml) {
        std::vector<Error> errors;
        collect(errors, [&] { parseScene(parseDocument(kMesh + toml, "scene.toml"), "scene.toml"); });
        return errors.empty() ? "" : errors.front().message;
    };
    EXPECT_NE(
        problemOf("[[node]]\nname = 'hub'\n[[instance]]\nmesh = 'm'\nparent = 'hbu'\n").find("did you mean 'hub'"),
        std::string::npos);
    EXPECT_NE(problemOf("[[node]]\nname = 'a'\nparent = 'b'\n[[node]]\nname = 'b'\nparent = 'a'\n")
                  .find("is its own ancestor"),
        std::string::npos);
    EXPECT_NE(problemOf("[[node]]\nname = 'a'\nparent = 'a'\n").find("is its own ancestor"), std::string::npos);
    EXPECT_NE(problemOf("[[node]]\nname = 'a'\n[[node]]\nname = 'a'\n[[instance]]\nmesh = 'm'\nparent = 'a'\n")
                  .find("there are several"),
        std::string::npos);
    EXPECT_NE(problemOf("[[instance]]\nmesh = 'm'\nrotate = [1, 2, 3]\nquaternion = [1, 0, 0, 0]\n")
                  .find("stands beside 'rotate'"),
        std::string::npos);
}

}  // namespace
}  // namespace limn
