#include "mesh/far_limit.h"

#include <opensubdiv/far/patchTableFactory.h>
#include <opensubdiv/far/primvarRefiner.h>

namespace limn {
using namespace OpenSubdiv;
using far::Value;

FarLimit::FarLimit(
    Far::TopologyRefiner& refiner, int depth, const std::vector<glm::dvec3>& points, const std::vector<glm::dvec2>& uvs)
    : ptex_(refiner) {
    Far::PatchTableFactory::Options options(depth);
    options.SetEndCapType(Far::PatchTableFactory::Options::ENDCAP_GREGORY_BASIS);
    options.SetPatchPrecision<double>();
    options.useInfSharpPatch = true;
    options.generateFVarTables = !uvs.empty();
    options.generateFVarLegacyLinearPatches = false;
    options.SetFVarPatchPrecision<double>();
    auto refinement = options.GetRefineAdaptiveOptions();
    refinement.considerFVarChannels = !uvs.empty();
    refiner.RefineAdaptive(refinement);
    table_.reset(Far::PatchTableFactory::Create(refiner, options));
    map_ = std::make_unique<Far::PatchMap>(*table_);

    const Far::PrimvarRefinerReal<double> primvars(refiner);
    std::vector<Value<3>> all(static_cast<std::size_t>(refiner.GetNumVerticesTotal() + table_->GetNumLocalPoints()));
    for (std::size_t i = 0; i < points.size(); ++i) all[i].v = points[i];
    Value<3>* from = all.data();
    for (int level = 1; level <= refiner.GetMaxLevel(); ++level) {
        Value<3>* to = from + refiner.GetLevel(level - 1).GetNumVertices();
        primvars.Interpolate(level, from, to);
        from = to;
    }
    if (table_->GetNumLocalPoints() > 0)
        table_->GetLocalPointStencilTable<double>()->UpdateValues(
            all.data(), all.data() + refiner.GetNumVerticesTotal());
    for (const auto& value : all) points_.push_back(value.v);

    if (uvs.empty()) return;
    std::vector<Value<2>> values(
        static_cast<std::size_t>(refiner.GetNumFVarValuesTotal(0) + table_->GetNumLocalPointsFaceVarying(0)));
    for (std::size_t i = 0; i < uvs.size(); ++i) values[i].v = uvs[i];
    Value<2>* at = values.data();
    for (int level = 1; level <= refiner.GetMaxLevel(); ++level) {
        Value<2>* to = at + refiner.GetLevel(level - 1).GetNumFVarValues(0);
        primvars.InterpolateFaceVarying(level, at, to, 0);
        at = to;
    }
    if (table_->GetNumLocalPointsFaceVarying(0) > 0)
        table_->GetLocalPointFaceVaryingStencilTable<double>(0)->UpdateValues(
            values.data(), values.data() + refiner.GetNumFVarValuesTotal(0));
    for (const auto& value : values) uvs_.push_back(value.v);
}

void FarLimit::evaluate(
    int face, int part, const glm::dvec2& st, glm::dvec3& point, glm::dvec3& ds, glm::dvec3& dt) const {
    point = ds = dt = glm::dvec3(0);
    const auto* patch = map_->FindPatch(ptex_.GetFaceId(face) + part, st.x, st.y);
    if (!patch) return;
    double weights[20], weightsS[20], weightsT[20];  // the largest patch is Loop's Gregory triangle with 18
    table_->EvaluateBasis(*patch, st.x, st.y, weights, weightsS, weightsT);
    const auto points = table_->GetPatchVertices(*patch);
    for (int i = 0; i < points.size(); ++i) {
        const glm::dvec3& p = points_[static_cast<std::size_t>(points[i])];
        point += weights[i] * p;
        ds += weightsS[i] * p;
        dt += weightsT[i] * p;
    }
}

glm::dvec2 FarLimit::uv(int face, int part, const glm::dvec2& st) const {
    const auto* patch = map_->FindPatch(ptex_.GetFaceId(face) + part, st.x, st.y);
    if (!patch) return glm::dvec2(0);
    double weights[20];
    table_->EvaluateBasisFaceVarying(*patch, st.x, st.y, weights);
    const auto values = table_->GetPatchFVarValues(*patch, 0);
    glm::dvec2 sum(0);
    for (int i = 0; i < values.size(); ++i) sum += weights[i] * uvs_[static_cast<std::size_t>(values[i])];
    return sum;
}

}  // namespace limn
