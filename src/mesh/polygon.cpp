// Filling polygons and outlines, with GLU's tessellator where they are not convex.

#include "mesh/section.h"

#include <GL/glu.h>

namespace limn {
namespace {

struct Tessellation {
    std::vector<std::uint32_t> indices;
    bool failed = false;
    std::vector<glm::dvec3>* points =
        nullptr;  ///< crossings append their points here; null: the heaviest of the four vertices stands in
};

// GLU carries corners as pointers, counted from 1: null means "none" to it.
std::uint32_t toIndex(void* data) { return static_cast<std::uint32_t>(reinterpret_cast<std::uintptr_t>(data)) - 1; }

void onVertex(void* vertex, void* user) { static_cast<Tessellation*>(user)->indices.push_back(toIndex(vertex)); }
void onEdgeFlag(GLboolean, void*) {}  // its registration makes GLU give plain triangles
void onError(GLenum, void* user) { static_cast<Tessellation*>(user)->failed = true; }
void onCombine(GLdouble* place, void* vertices[4], GLfloat weights[4], void** out, void* user) {
    if (auto* points = static_cast<Tessellation*>(user)->points) {
        points->emplace_back(place[0], place[1], place[2]);
        *out = reinterpret_cast<void*>(points->size());
        return;
    }
    int heaviest = 0;
    for (int i = 1; i < 4; ++i)
        if (vertices[i] && weights[i] > weights[heaviest]) heaviest = i;
    *out = vertices[heaviest];
}

GLUtesselator* makeTessellator(const glm::dvec3& normal) {
    GLUtesselator* tess = gluNewTess();
    // GLU declares its callbacks as functions without parameters.
    const auto callback = [](auto function) { return reinterpret_cast<void (*)()>(function); };
    gluTessCallback(tess, GLU_TESS_VERTEX_DATA, callback(&onVertex));
    gluTessCallback(tess, GLU_TESS_EDGE_FLAG_DATA, callback(&onEdgeFlag));
    gluTessCallback(tess, GLU_TESS_ERROR_DATA, callback(&onError));
    gluTessCallback(tess, GLU_TESS_COMBINE_DATA, callback(&onCombine));
    gluTessProperty(tess, GLU_TESS_WINDING_RULE, GLU_TESS_WINDING_NONZERO);
    gluTessNormal(tess, normal.x, normal.y, normal.z);
    return tess;
}

glm::dvec3 newellNormal(const std::vector<glm::dvec3>& polygon) {
    glm::dvec3 normal(0);
    for (std::size_t i = 0; i < polygon.size(); ++i)
        normal += glm::cross(polygon[i] - polygon[0], polygon[(i + 1) % polygon.size()] - polygon[0]);
    return normal;
}

std::vector<std::uint32_t> fan(std::size_t corners) {
    std::vector<std::uint32_t> indices;
    for (std::uint32_t i = 1; i + 1 < corners; ++i) indices.insert(indices.end(), {0, i, i + 1});
    return indices;
}

}  // namespace

std::vector<std::uint32_t> triangulatePolygon(const std::vector<glm::dvec3>& polygon) {
    const glm::dvec3 normal = newellNormal(polygon);
    bool convex = true;
    for (std::size_t i = 0; i < polygon.size() && convex; ++i) {
        const auto& a = polygon[i];
        const auto& b = polygon[(i + 1) % polygon.size()];
        const auto& c = polygon[(i + 2) % polygon.size()];
        convex = glm::dot(glm::cross(b - a, c - b), normal) >= 0;
    }
    // A star turns the same way at every corner too, but goes around more than once: trust only small polygons.
    if (glm::dot(normal, normal) == 0 || (convex && polygon.size() <= 4)) return fan(polygon.size());

    Tessellation result;
    GLUtesselator* tess = makeTessellator(glm::normalize(normal));
    gluTessBeginPolygon(tess, &result);
    gluTessBeginContour(tess);
    std::vector<glm::dvec3> points = polygon;
    for (std::size_t i = 0; i < points.size(); ++i)
        gluTessVertex(tess, &points[i].x, reinterpret_cast<void*>(static_cast<std::uintptr_t>(i + 1)));
    gluTessEndContour(tess);
    gluTessEndPolygon(tess);
    gluDeleteTess(tess);
    if (result.failed || result.indices.empty() || result.indices.size() % 3 != 0) return fan(polygon.size());
    return result.indices;
}

std::vector<std::uint32_t> triangulateOutlines(std::vector<glm::dvec3>& points,
    const std::vector<std::vector<std::uint32_t>>& outlines, const glm::dvec3& normal) {
    if (outlines.empty()) return {};
    Tessellation result{{}, false, &points};
    GLUtesselator* tess = makeTessellator(normal);
    std::vector<glm::dvec3> places = points;  // GLU keeps pointers while `points` may grow
    gluTessBeginPolygon(tess, &result);
    for (const auto& outline : outlines) {
        gluTessBeginContour(tess);
        for (const auto i : outline)
            gluTessVertex(tess, &places[i].x, reinterpret_cast<void*>(static_cast<std::uintptr_t>(i) + 1));
        gluTessEndContour(tess);
    }
    gluTessEndPolygon(tess);
    gluDeleteTess(tess);
    if (result.failed || result.indices.size() % 3 != 0) return {};
    return result.indices;
}

}  // namespace limn
