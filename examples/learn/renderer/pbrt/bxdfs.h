// pbrt: bxdfs.h
class GonioBxDF {
  public:
    GonioBxDF() = default;
    GonioBxDF(const gonio::render::bsdf_view *paint, const SampledWavelengths &lambda) : paint(paint), lambda(lambda) {}

    SampledSpectrum f(Vector3f wo, Vector3f wi, TransportMode) const {
        if (!SameHemisphere(wo, wi)) return SampledSpectrum(0.f);
        return Spectral(paint->eval(Front(wi, wo), Front(wo, wo)), 1);  // the light first
    }
    pstd::optional<BSDFSample> Sample_f(Vector3f wo, Float uc, Point2f u, TransportMode,
                                        BxDFReflTransFlags sampleFlags = BxDFReflTransFlags::All) const {
        if (!(sampleFlags & BxDFReflTransFlags::Reflection)) return {};
        auto drawn = paint->sample(Front(wo, wo), float(u[0]), float(u[1]));
        if (!(drawn.pdf > 0 && drawn.wi[2] > 0)) return {};
        Vector3f wi(drawn.wi[0], drawn.wi[1], wo.z < 0 ? -drawn.wi[2] : drawn.wi[2]);
        // pbrt needs f, not f cos / pdf.
        return BSDFSample(Spectral(drawn.weight, drawn.pdf / drawn.wi[2]), wi, drawn.pdf, BxDFFlags::GlossyReflection);
    }
    Float PDF(Vector3f wo, Vector3f wi, TransportMode,
              BxDFReflTransFlags sampleFlags = BxDFReflTransFlags::All) const {
        if (!(sampleFlags & BxDFReflTransFlags::Reflection) || !SameHemisphere(wo, wi)) return 0;
        return paint->eval_pdf(Front(wi, wo), Front(wo, wo));
    }
    void Regularize() {}
    BxDFFlags Flags() const { return BxDFFlags::GlossyReflection; }
    static constexpr const char *Name() { return "GonioBxDF"; }
    std::string ToString() const { return "[ GonioBxDF ]"; }

  private:
    // The back looks the same as the front.
    static gonio::render::bsdf_view::vector Front(Vector3f w, Vector3f wo) {
        return {float(w.x), float(w.y), float(wo.z < 0 ? -w.z : w.z)};
    }
    SampledSpectrum Spectral(const gonio::render::bsdf_view::colour &c, float scale) const {
        RGB rgb(scale * c[0], scale * c[1], scale * c[2]);  // above 1 in a highlight: unbounded, not an albedo
        return RGBUnboundedSpectrum(*RGBColorSpace::sRGB, rgb).Sample(lambda);
    }
    const gonio::render::bsdf_view *paint = nullptr;
    SampledWavelengths lambda;
};
