// pbrt: materials.h
    using BxDF = GonioBxDF;
    GonioMaterial(const std::string &filename, FloatTexture displacement, Image *normalMap, Allocator)
        : displacement(displacement), normalMap(normalMap), paint(read_paint(filename)) {}
    template <typename TextureEvaluator>
    GonioBxDF GetBxDF(TextureEvaluator, const MaterialEvalContext &, SampledWavelengths &lambda) const {
        return GonioBxDF(&paint.bsdf, lambda);
    }
    measured_paint paint;  // private, instead of brdf
