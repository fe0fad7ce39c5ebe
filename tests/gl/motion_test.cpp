// The AOV `motion`: where the visible point was in the frame before.

#include "support/bench.h"

#include <fmt/format.h>
#include <gtest/gtest.h>
#include <glm/gtc/type_ptr.hpp>

#include <cmath>

namespace limn::test {
namespace {

const std::string kAsked =
    "[image]\nsize = [96, 64]\nsamples = 4\n[output]\naovs = ['motion', 'position', 'object_id']\n";

TEST(Motion, ofAMovingCardIsItsSpeed) {
    // 16 pixels a unit; 0.5 units to the right and 0.25 up each frame.
    const std::string scene = R"(
        [animation]
        frames = "1-10"
        [[mesh]]
        name = 'card'
        file = 'card.obj'
        [[instance]]
        mesh = 'card'
        translate = { keys = [[1, [-2, -1, 0]], [9, [2, 1, 0]]] }
    )" + cameraToml({0, 0, 5}, {0, 0, 0}, "orthographic_height = 4");
    const auto card = quadObj({-0.6, -0.6, 0}, {0.6, -0.6, 0}, {0.6, 0.6, 0}, {-0.6, 0.6, 0});
    for (const int frame : {1, 5}) {
        const Picture p = draw(makeConfig(kAsked), makeScene(scene, {{"card.obj", card}}), {}, frame);
        int seen = 0;
        for (int y = 0; y < 64; ++y)
            for (int x = 0; x < 96; ++x) {
                const bool isCard = p.aov("object_id").at(x, y)[0] == 1;
                seen += isCard;
                const float* motion = p.aov("motion").at(x, y);
                EXPECT_NEAR(motion[0], isCard && frame > 1 ? 8 : 0, 1e-4);
                EXPECT_NEAR(motion[1], isCard && frame > 1 ? 4 : 0, 1e-4);
            }
        EXPECT_GT(seen, 100);
    }
}

TEST(Motion, leadsToTheSamePointInTheFrameBefore) {
    // The camera moves: where the point was visible a frame ago, the position seen there is the position now.
    const std::string scene = R"(
        [animation]
        frames = "1-10"
        [[mesh]]
        name = 'm'
        file = 'm.obj'
        [[camera]]
        position = { keys = [[1, [3, 4, 6]], [10, [6, 3, 2]]] }
        look_at = [0, 0.5, 0]
        fov = 50
    )";
    const LoadedScene loaded = makeScene(scene, {{"m.obj", mixedObj()}});
    const Picture before = draw(makeConfig(kAsked), loaded, {}, 4), now = draw(makeConfig(kAsked), loaded, {}, 5);
    int compared = 0, moved = 0;
    double sum = 0, stayed = 0;
    for (int y = 1; y < 63; ++y)
        for (int x = 1; x < 95; ++x) {
            const float* motion = now.aov("motion").at(x, y);
            const float id = now.aov("object_id").at(x, y)[0];
            const float px = static_cast<float>(x) - motion[0], py = static_cast<float>(y) + motion[1];
            const int left = static_cast<int>(std::floor(px)), top = static_cast<int>(std::floor(py));
            if (id == 0 || left < 0 || top < 0 || left > 94 || top > 62) continue;
            moved += std::hypot(motion[0], motion[1]) > 2;
            const glm::vec3 p = glm::make_vec3(now.aov("position").at(x, y));
            // Of the four pixels around, some saw the same flat surface: its plane goes through the point.
            float best = 1e9f;
            for (int k = 0; k < 4; ++k) {
                const int qx = left + k % 2, qy = top + k / 2;
                if (before.aov("object_id").at(qx, qy)[0] != id) continue;
                best = std::min(best, glm::distance(p, glm::make_vec3(before.aov("position").at(qx, qy))));
            }
            if (best == 1e9f) continue;
            ++compared;
            sum += best;
            stayed += glm::distance(p, glm::make_vec3(before.aov("position").at(x, y)));
        }
    EXPECT_GT(compared, 2000);
    // A pixel is about 0.1 wide here, slanted surfaces go further in one, and the nearest of four is half of that away.
    EXPECT_LT(sum / compared, 0.1);
    EXPECT_GT(stayed / compared, 0.2) << "without the motion it would be far off";
    EXPECT_GT(moved, compared / 2);
}

}  // namespace
}  // namespace limn::test
