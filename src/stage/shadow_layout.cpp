#include "stage/shadow_layout.h"

#include <algorithm>

namespace limn {

ShadowLayout shadowLayout(std::span<const Light> lights) {
    constexpr int kRow = 8192;  // texels in a row of maps; further maps go in the next row
    ShadowLayout layout;
    glm::ivec2 pen(0);
    int rowHeight = 0;
    for (std::size_t l = 0; l < lights.size(); ++l) {
        if (!lights[l].shadow.present) continue;
        const int side = lights[l].shadow.resolution;
        for (int face = 0; face < (lights[l].kind == LightKind::point ? 6 : 1); ++face) {
            if (pen.x > 0 && pen.x + side > kRow) {
                pen = {0, pen.y + rowHeight};
                rowHeight = 0;
            }
            layout.maps.push_back({{pen, side, side}, static_cast<int>(l) * 8 + face});
            pen.x += side;
            rowHeight = std::max(rowHeight, side);
            layout.size = glm::max(layout.size, glm::ivec2(pen.x, pen.y + rowHeight));
        }
    }
    return layout;
}

ContentKey shadowsKey(const SceneAt& scene, std::span<const ContentKey> meshOf) {
    KeyBuilder key;
    for (const Light& light : scene.lights) {
        key.add(light.shadow.present);
        if (!light.shadow.present) continue;
        key.add(light.kind).add(light.shadow.resolution).add(light.angle);
        for (int k = 0; k < 3; ++k) key.add(light.position[k]).add(light.direction[k]);
    }
    key.bytes(&scene.info.bounds, sizeof scene.info.bounds);
    for (std::size_t i = 0; i < scene.instances.size(); ++i) {
        const DrawInstance& instance = scene.instances[i];
        key.add(meshOf[i].low).add(meshOf[i].high).bytes(&instance.worldFromMesh, sizeof instance.worldFromMesh);
        for (const auto material : instance.materials)  // cut-outs cut holes into shadows
            if (!scene.materials[material].cutout.empty()) {
                const ContentKey &look = scene.materialKeys[material], &texture = scene.textureKeys[material];
                key.add(look.low).add(look.high).add(texture.low).add(texture.high);
            }
    }
    return key.key();
}

}  // namespace limn
