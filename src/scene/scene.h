// A scene: plain data, as described by a scene file. Doubles, scene units, right-handed.
#pragma once

#include "settings/fields.h"

#include <glm/glm.hpp>

#include <algorithm>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace limn {

enum class Axis { y, z };
template <>
inline constexpr std::array<std::string_view, 2> enumNames<Axis> = {"y", "z"};

/// How a texture is read between its texels. `automatic` is `nearest` for a texture of at most 64 texels a side that
/// cuts no holes: it was drawn texel by texel, but outlines of holes would become stairs. Else it is `linear`.
enum class TextureFilter { automatic, linear, nearest };
template <>
inline constexpr std::array<std::string_view, 3> enumNames<TextureFilter> = {"automatic", "linear", "nearest"};

enum class LightKind { sun, point, spot };
template <>
inline constexpr std::array<std::string_view, 3> enumNames<LightKind> = {"sun", "point", "spot"};

/// Warm paper grey: the colour of an object without a material.
inline constexpr Color kPaperGrey{0.604f, 0.571f, 0.521f};  // #cbc6be

/// Parallel lines in the picture.
struct Hatch {
    double spacing = 0;  ///< pixels; 0: none
    double width = 1;    ///< pixels
    double angle = 45;   ///< degrees from the horizontal
    Color color;
};

/// What sections show of a material. What is not said is the section's.
struct CutLook {
    OptionalColor fill;
    PictureLength hatch{-1, PictureLength::Unit::pixels};  ///< distance of hatching lines; 0: none; below 0: not said
    double hatchAngle = -1;                                ///< degrees from the picture's horizontal; below 0: not said
    OptionalColor hatchColor;
};

/// What texture coordinates may be multiplied by or moved by, at most.
inline constexpr double kMostRepeats = 1e6;

struct Material {
    std::string name;
    Color color = kPaperGrey;
    std::string texture;  ///< image file multiplied onto the colour; empty = none
    std::string cutout;  ///< image file: holes where its alpha, or else its brightness, is below one half; empty = none
    glm::dvec2 textureScale{1};   ///< factor on texture coordinates: 2 shows the image twice
    glm::dvec2 textureOffset{0};  ///< added after the scale: 0.5 moves the image by half of itself
    bool textureRepeats = true;   ///< false: the image's border continues beyond it
    TextureFilter textureFilter = TextureFilter::automatic;
    bool vertexColors = true;  ///< multiply the mesh's vertex colours, where it has any, onto the colour
    float shininess = 0;       ///< Blinn–Phong exponent; no highlight at 1 or below
    float specular = 1;        ///< strength of the highlight
    bool lines = true;         ///< are lines drawn?
    OptionalColor lineColor;
    double creaseAngle = 0;  ///< degrees; 0 = as the line technique says
    bool isCut = false;      ///< the cut face of a section
    Hatch hatch;             ///< lines across it, on the cut faces of sections
    CutLook cut;             ///< of its own cut faces
};

/// Are the texels of a material's image visible as squares? `size`: in texels.
inline bool hasSharpTexels(const Material& material, glm::ivec2 size) {
    const int side = std::max(size.x, size.y);
    return material.textureFilter == TextureFilter::nearest
        || (material.textureFilter == TextureFilter::automatic && material.cutout.empty() && side > 1 && side <= 64);
}

/// A plane that cuts the scene open and removes everything on its normal's side.
struct Section {
    std::string name;  ///< cut only where a config names it; empty: always
    glm::dvec3 point{0};
    glm::dvec3 normal{0, 0, 1};
    Color fill{0.08f, 0.08f, 0.08f};
    PictureLength hatch;     ///< distance of hatching lines over the fill; 0: none
    double hatchAngle = 45;  ///< degrees from the picture's horizontal
    PictureLength hatchWidth{0.18, PictureLength::Unit::millimetres};
    Color hatchColor{1, 1, 1};
};

enum class SubdivisionSchemeName { catmullClark, loop, bilinear };
template <>
inline constexpr std::array<std::string_view, 3> enumNames<SubdivisionSchemeName> = {
    "catmull-clark", "loop", "bilinear"};
enum class BoundaryName { file, none, edgeOnly, edgeAndCorner };
template <>
inline constexpr std::array<std::string_view, 4> enumNames<BoundaryName> = {
    "file", "none", "edge_only", "edge_and_corner"};
enum class UvBoundaryName { file, none, cornersOnly, cornersPlus1, cornersPlus2, boundaries, all };
template <>
inline constexpr std::array<std::string_view, 7> enumNames<UvBoundaryName> = {
    "file", "none", "corners_only", "corners_plus1", "corners_plus2", "boundaries", "all"};
enum class CreaseMethodName { file, normal, chaikin };
template <>
inline constexpr std::array<std::string_view, 3> enumNames<CreaseMethodName> = {"file", "normal", "chaikin"};
/// How a mesh is subdivided. "file" takes the mesh's own tags; without tags it means edge_and_corner, boundaries and
/// normal.
struct SubdivisionSettings {
    bool present = false;
    SubdivisionSchemeName scheme = SubdivisionSchemeName::catmullClark;
    int level = 2;
    bool limit = true;
    std::string edgeLength;  ///< "2px" or a length in scene units; empty: level alone decides
    BoundaryName boundary = BoundaryName::file;
    UvBoundaryName uvBoundary = UvBoundaryName::file;
    CreaseMethodName creaseMethod = CreaseMethodName::file;
    bool weld = true;  ///< join what is split along seams of texture coordinates

    /// The value of edgeLength, in pixels or scene units. Nullopt when it is empty or no length.
    struct EdgeLength {
        double amount;
        bool isPixels;
    };
    std::optional<EdgeLength> wantedEdge() const;
};

/// What a mesh with a file per frame shows before its first file and after its last.
enum class SequenceEnds { hold, loop, bounce };
template <>
inline constexpr std::array<std::string_view, 3> enumNames<SequenceEnds> = {"hold", "loop", "bounce"};

/// Which of a mesh's numbered files a frame shows.
struct SequenceSettings {
    bool present = false;  ///< false: the file of the frame's own number
    int first = 1, last = 1;
    double start = 1;  ///< the frame that shows the first file
    double speed = 1;  ///< files per frame
    SequenceEnds ends = SequenceEnds::hold;

    /// The number of the file at a frame.
    int fileAt(double frame) const;
};

struct MeshSource {
    std::string name;
    std::string file;                              ///< absolute, or relative to the working directory
    bool perFrame = false;                         ///< the file's name is a pattern: #### stands for the frame number
    std::vector<std::string> parts, withoutParts;  ///< patterns: only these parts of the file, and not those
    SequenceSettings sequence;
    std::string creases;  ///< sidecar of creases and corners; empty = none
    SubdivisionSettings subdivision;
    Location where;

    /// The number of the file to read at a frame, and that file. Without a file per frame the number is 0.
    int numberAt(int frame) const;
    std::filesystem::path at(int frame) const;
};

/// How a mesh file is drawn that is a scene by itself.
struct MeshFileOptions {
    std::optional<int> subdivide;  ///< as a Catmull-Clark surface of this level
    std::optional<Axis> up;        ///< the axis that points up; y if nothing is said
};

/// A place in the scene, relative to another one.
struct Placement {
    std::string name;
    std::string parent;  ///< an instance or a node; empty: the scene
    glm::dvec3 translate{0};
    glm::dvec3 rotate{0};               ///< degrees, about x, then y, then z
    glm::dquat quaternion{1, 0, 0, 0};  ///< instead of rotate
    glm::dvec3 scale{1};
    std::vector<double> matrix;  ///< 16 numbers in row order; replaces all of these

    /// To the parent.
    glm::dmat4 transform() const;
};

struct Instance : Placement {
    std::string mesh;
    std::string material;  ///< replaces every material of the mesh; empty = the file's own
    bool visible = true;
    bool lines = true;        ///< are lines drawn?
    OptionalColor lineColor;  ///< overrides the material's, as does:
    double creaseAngle = 0;   ///< degrees; 0 = as the material says
};

struct Camera {
    std::string name;
    std::string parent;  ///< an instance or a node that position, lookAt and up belong to; empty: the scene
    glm::dvec3 position{0, 0, 5};
    glm::dvec3 lookAt{0, 0, 0};
    std::string target;             ///< an instance or a node: lookAt is counted from its origin, in the scene's axes
    double orbit = 0;               ///< degrees that the camera has gone around lookAt, about up, against the clock
    glm::dvec3 up{0};               ///< zero: the scene's up axis
    double focalLength = 0;         ///< mm; 0 = by fov
    double sensorWidth = 36;        ///< mm
    double fov = 0;                 ///< degrees, horizontal; 0 = by focal length (35 mm when neither is given)
    double orthographicHeight = 0;  ///< scene units; above 0 the camera is orthographic
    glm::dvec2 shift{0};            ///< fraction of the larger image side, as in Blender
    double near = 0;                ///< scene units; 0 = chosen from the scene
    double far = 0;                 ///< scene units; 0 = the scene's far end; only paper modes depend on it
};

struct ShadowSettings {
    bool present = false;
    int resolution = 2048;
    float softness = 1;  ///< texels
};

struct Light {
    std::string name;
    std::string parent;  ///< an instance or a node that direction and position belong to; empty: the scene
    LightKind kind = LightKind::sun;
    glm::dvec3 direction{-1, -2, -1};  ///< travel direction; sun and spot
    glm::dvec3 position{0, 3, 0};      ///< point and spot
    Color color{1, 1, 1};
    double intensity = 1;
    double range = 0;     ///< scene units at which a point or spot light falls to half; 0 = no falloff
    double angle = 45;    ///< degrees, full cone of a spot
    double blend = 0.15;  ///< part of the cone over which a spot fades out
    ShadowSettings shadow;
};

struct FrameRange {
    int first = 1, last = 1;
};

struct Scene {
    std::string file;
    Axis up = Axis::y;
    double metersPerUnit = 1;
    std::vector<MeshSource> meshes;
    std::vector<Keyed<Instance>> instances;
    std::vector<Keyed<Placement>> nodes;  ///< places without a mesh
    std::vector<Keyed<Camera>> cameras;
    std::vector<Keyed<Light>> lights;
    std::vector<Keyed<Material>> materials;
    std::vector<Keyed<Section>> sections;
    std::optional<FrameRange> frames;  ///< declared frames; none for a still
    double fps = 24;

    /// From a place to the scene, through its parents.
    glm::dmat4 worldFrom(const Placement& place, double frame) const;
    /// From an instance or node to the scene; no name: the scene itself.
    glm::dmat4 worldFrom(std::string_view name, double frame) const;

    glm::dvec3 upVector() const { return up == Axis::y ? glm::dvec3(0, 1, 0) : glm::dvec3(0, 0, 1); }
    /// The frame at which relative lengths are resolved.
    int firstFrame() const { return frames ? frames->first : 1; }
};

}  // namespace limn
