// Tests that compare pictures, tested: with one of the pictures changed by two percent, each must fail.

#include "support/bench.h"

#include <fmt/format.h>
#include <gtest/gtest.h>
#include <sys/wait.h>

#include <cstdlib>
#include <filesystem>

namespace limn::test {
namespace {

/// A test, which of the pictures it draws is changed, and how: as LIMN_TEST_ONE_SIDE says it.
struct Change {
    const char* test;
    const char* change;
};

const Change kChanges[] = {
    {"Culling.changesNoBit", "lens 2"},
    {"DepthTangent.looksTheSameAtEveryResolution", "values 3"},
    {"DepthTangent.inBothSlotsIsOnePassFromDepthAlone", "values 1"},
    {"Holes.ofEverythingLeaveWhatLiesBehind", "values 1"},  // a plane that fills the picture, whatever the lens
    {"Holes.ofNothingChangeNothing", "lens 2"},
    {"Holes.keepTheirShareInTheDistance", "lens 2"},
    {"Occlusion.halfResolutionAgrees", "values 2"},
    {"Occlusion.ofAPartOfTheSamplesIsNoisierAndNothingElse", "lens 3"},
    {"Picture.transparentPicturesCompositeToOpaqueOnes", "lens 2"},
    {"Picture.aCropIsThatPartOfTheWhole", "lens 2"},
    {"Picture.samplesAverageToTheSamePicture", "lens 3"},
    {"Picture.dataIsTakenAtPixelCentres", "lens 2"},
    {"Picture.positionsLieWhereDepthSays", "values 1"},
    {"Picture.mirroredAndShearedInstancesStayRight", "lens 2"},
    {"Picture.exactAndFastAgree", "lens 2"},
    {"Reference.instancesAreTheirCopies", "lens 2"},
    {"Tiles.ofAnySizeMakeTheSamePicture", "lens 2"},
    {"Tiles.arriveInBandsFromTheTop", "lens 1"},
    {"Lines.areAsWideInMillimetresAtEveryResolution", "lens 2"},
    {"Sequence.drawsTheFileOfEachFrame", "values 2"},
};

class OneSide : public testing::TestWithParam<Change> {};
INSTANTIATE_TEST_SUITE_P(Changed, OneSide, testing::ValuesIn(kChanges), [](const auto& instance) {
    std::string name = std::string(instance.param.test) + "_" + instance.param.change;
    for (char& c : name)
        if (c == '.' || c == ' ') c = '_';
    return name;
});

TEST_P(OneSide, fails) {
    const auto program = std::filesystem::read_symlink("/proc/self/exe");
    const int status = std::system(fmt::format("LIMN_TEST_ONE_SIDE='{}' '{}' --gtest_filter={} >/dev/null 2>&1",
        GetParam().change, program.string(), GetParam().test)
                                       .c_str());
    ASSERT_TRUE(WIFEXITED(status));
    EXPECT_EQ(WEXITSTATUS(status), 1) << "it takes one picture for another";
}

}  // namespace
}  // namespace limn::test
