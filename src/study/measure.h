// One setting of a study, timed and compared with the truth.
#pragma once

#include "study/sweep.h"

namespace limn {

struct Shot {
    std::string camera;  ///< empty: the config's
    int frame = 1;
};

class Measurer {
public:
    Measurer(Session& session, const StudyConfig& study, const SweepSettings& settings, std::vector<Shot> shots);

    /// Times and errors of a setting; pictures of the first shot. The first call finds the truth, which takes longest.
    StudyPoint measure(const Settings& settings, PointPictures& pictures);
    /// Where the error of ambient occlusion comes from, for a setting of the config that draws it.
    ErrorSplit split(const Settings& settings);
    /// Draws the first shot once: finds what cannot be drawn before time is spent on the truth.
    void tryDrawing(const Settings& settings);

    double truthError() const { return truthError_; }
    /// The true pictures of the first shot: display-encoded colours, and visibility (empty without ambient occlusion).
    std::pair<Image, Image> truePictures();
    const std::vector<Shot>& shots() const { return shots_; }

private:
    struct Truth {
        std::vector<float> picture;           ///< display-encoded RGB
        std::vector<float> occlusion, shell;  ///< visibility; negative on the background
        std::vector<PixelClass> classes;
        RenderedFrame surface;  ///< depth and normal of the finest geometry, where there are cages
    };

    const Truth& truth(std::size_t shot);
    RenderedFrame draw(const Variant& variant, const Shot& shot, std::vector<const Aov*> aovs, int guard = 0);
    Settings finest(Settings settings, const Shot& shot) const;
    void findOcclusion(Truth& truth, const Shot& shot);
    void time(const Variant& variant, StudyPoint& point);
    GeometryError geometryError(const RenderedFrame& seen, const RenderedFrame& finest) const;

    Session& session_;
    const StudyConfig& study_;
    const SweepSettings& settings_;
    std::vector<Shot> shots_;
    std::map<std::size_t, Truth> truths_;
    double truthError_ = 0;
    bool hasCages_ = false, hasOcclusion_ = false;
};

}  // namespace limn
