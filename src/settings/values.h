// What people write besides plain numbers: colours, and lengths in the scene or in the picture.
#pragma once

namespace limn {

/// Linear Rec.709. Read from sRGB hex ("#rrggbb") or a linear triple.
struct Color {
    float r = 0, g = 0, b = 0;
    bool operator==(const Color&) const = default;
};

/// A colour that need not be given.
struct OptionalColor {
    bool given = false;
    Color color;
    Color otherwise(const Color& other) const { return given ? color : other; }
    bool operator==(const OptionalColor&) const = default;
};

/// A length in the scene: scene units, or a fraction of the scene's bounding-box diagonal ("5%").
struct Length {
    double amount = 0;
    bool relative = false;

    static constexpr Length units(double amount) { return {amount, false}; }
    static constexpr Length percent(double percent) { return {percent / 100, true}; }
    double inSceneUnits(double diagonal) const { return relative ? amount * diagonal : amount; }
    bool operator==(const Length&) const = default;
};

/// A length in the picture: pixels of the output image, millimetres on paper (needs image.dpi), or a fraction of the
/// image height.
struct PictureLength {
    enum class Unit { pixels, millimetres, imageHeight };
    double amount = 0;
    Unit unit = Unit::pixels;

    static constexpr PictureLength pixels(double amount) { return {amount, Unit::pixels}; }
    /// In pixels of the output image.
    double inPixels(double imageHeight, double dpi) const {
        return unit == Unit::pixels ? amount : unit == Unit::millimetres ? amount / 25.4 * dpi : amount * imageHeight;
    }
    bool operator==(const PictureLength&) const = default;
};

}  // namespace limn
