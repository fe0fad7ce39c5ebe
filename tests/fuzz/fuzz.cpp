// Fuzz targets for everything that reads text from strangers. One source, three programs: FUZZ_OBJ, FUZZ_MTL or
// FUZZ_CONFIG.
//
// Built and run by tests/fuzz/run.sh with clang, AddressSanitizer and UndefinedBehaviorSanitizer. Errors are answers;
// crashes are not.

#include "formats/mtl.h"
#include "formats/obj.h"
#include "formats/scene_file.h"
#include "mesh/far.h"
#include "mesh/subdivide.h"
#include "mesh/topology.h"
#include "render/config.h"
#include "settings/document.h"

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <string_view>

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    const std::string_view text(reinterpret_cast<const char*>(data), size);
    try {
#if defined(FUZZ_OBJ)
        // However the work is split, the same mesh; then all that is done to meshes.
        limn::ObjFile file = limn::parseObj(text, "fuzz", 1 + static_cast<int>(size % 5));
        limn::repairTopology(file.mesh, file.warnings);
        static_cast<void>(limn::analyseTopology(file.mesh));
        static_cast<void>(limn::buildTriMesh(file.mesh, {true, true, size % 2 == 0, true}));
        limn::SubdivisionOptions options = limn::withTags({}, file.mesh.tags);
        options.level = 1;
        options.safe = size % 3 == 0;
        // Refinement is forty times slower when watched this closely: only as much of it as takes a second or two.
        const int levels = std::min(std::max(limn::levelsOfCreases(file.mesh.tags), 5), 10);
        if (file.mesh.faceCount() << levels < 800)
            static_cast<void>(limn::subdivide(file.mesh, options, {true, true, false, true}, "fuzz"));
#elif defined(FUZZ_MTL)
        static_cast<void>(limn::parseMtl(text, "/nowhere"));
#else
        const limn::Node document = limn::parseDocument(text, "fuzz");
        // A text that is no scene may be a config, and the other way round.
        try {
            static_cast<void>(limn::parseScene(document, "fuzz.toml"));
        } catch (const limn::Errors&) {}
        static_cast<void>(limn::parseRenderConfig(document, "fuzz.toml"));
#endif
    } catch (const limn::Error&) {
    } catch (const limn::Errors&) {}
    return 0;
}
