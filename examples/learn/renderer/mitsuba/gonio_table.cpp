// mitsuba: gonio_table.cpp
#include <mitsuba/core/fresolver.h>
#include <mitsuba/core/properties.h>
#include <mitsuba/render/bsdf.h>
#include <measured_paint.hpp>

NAMESPACE_BEGIN(mitsuba)

template <typename Float, typename Spectrum>
class GonioTable final : public BSDF<Float, Spectrum> {
public:
    MI_IMPORT_BASE(BSDF, m_flags, m_components)
    MI_IMPORT_TYPES()

    static constexpr bool Usable = !dr::is_jit_v<Float> && is_rgb_v<Spectrum> && !is_polarized_v<Spectrum>;

    GonioTable(const Properties &props)
        : Base(props), m_paint(read_paint(file_resolver()->resolve(props.get<std::string_view>("filename")).string())) {
        if constexpr (!Usable) Throw("gonio_table is for the variant scalar_rgb");
        m_flags = BSDFFlags::GlossyReflection | BSDFFlags::FrontSide;
        m_components.push_back(m_flags);
    }

    std::pair<BSDFSample3f, Spectrum> sample(const BSDFContext &ctx, const SurfaceInteraction3f &si,
                                             Float /* sample1 */, const Point2f &sample2, Mask active) const override {
        MI_MASKED_FUNCTION(ProfilerPhase::BSDFSample, active);
        BSDFSample3f bs = dr::zeros<BSDFSample3f>();
        if constexpr (Usable) {
            auto drawn = m_paint.bsdf.sample(array(si.wi), (float) sample2.x(), (float) sample2.y());
            if (ctx.is_enabled(BSDFFlags::GlossyReflection) && drawn.pdf > 0.f && drawn.wi[2] > 0.f) {
                bs.wo = Vector3f(drawn.wi[0], drawn.wi[1], drawn.wi[2]);
                bs.pdf = drawn.pdf;
                bs.eta = 1.f;
                bs.sampled_type = +BSDFFlags::GlossyReflection;
                bs.sampled_component = 0;
                return { bs, Spectrum(drawn.weight[0], drawn.weight[1], drawn.weight[2]) };  // with the cosine
            }
        }
        return { bs, 0.f };
    }

    Spectrum eval(const BSDFContext &ctx, const SurfaceInteraction3f &si, const Vector3f &wo,
                  Mask active) const override {
        MI_MASKED_FUNCTION(ProfilerPhase::BSDFEvaluate, active);
        if constexpr (Usable)
            if (ctx.is_enabled(BSDFFlags::GlossyReflection)) {
                auto f = m_paint.bsdf.eval(array(wo), array(si.wi));  // the light's direction is Mitsuba's wo
                return Spectrum(f[0], f[1], f[2]) * Frame3f::cos_theta(wo);
            }
        return 0.f;
    }

    Float pdf(const BSDFContext &ctx, const SurfaceInteraction3f &si, const Vector3f &wo, Mask active) const override {
        MI_MASKED_FUNCTION(ProfilerPhase::BSDFEvaluate, active);
        if constexpr (Usable)
            if (ctx.is_enabled(BSDFFlags::GlossyReflection) && Frame3f::cos_theta(wo) > 0.f)
                return m_paint.bsdf.eval_pdf(array(wo), array(si.wi));
        return 0.f;
    }

    std::string to_string() const override { return "GonioTable[]"; }

    MI_DECLARE_CLASS(GonioTable)
private:
    static gonio::render::bsdf_view::vector array(const Vector3f &w) {
        if constexpr (Usable) return { (float) w.x(), (float) w.y(), (float) w.z() };
        else return {};
    }
    measured_paint m_paint;
};

MI_EXPORT_PLUGIN(GonioTable)
NAMESPACE_END(mitsuba)
