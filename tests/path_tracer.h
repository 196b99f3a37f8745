// A small path tracer on the CPU, in double precision: a witness of the renderer's light transport that shares nothing
// with it but the scene. Shapes are met by their equations instead of a distance field, directions are sampled in
// another way.
#pragma once

#include "sdf/scene.h"

#include <glm/mat3x3.hpp>
#include <glm/vec3.hpp>

#include <optional>
#include <random>
#include <vector>

namespace farfield {

class PathTracer {
public:
    /// Takes boxes, spheres and capped cylinders right below the root; throws std::invalid_argument on anything else.
    explicit PathTracer(const Scene& scene);

    /// One sample of the radiance that pixel (x, y) of a square picture of `size` sees, x to the right, y down: Lambert
    /// and Phong highlight of the lights, emission, and the scene's number of diffuse bounces.
    glm::dvec3 sample(int x, int y, int size, std::mt19937_64& random) const;

private:
    struct Shape {
        NodeKind kind;
        glm::dvec3 extent;  ///< half size; radius; radius and half height
        glm::dvec3 centre;
        glm::dmat3 to_world;  ///< a rotation
        const Material* material;
    };
    struct Hit {
        double distance;
        glm::dvec3 position, normal;
        const Material* material;
    };
    std::optional<Hit> first_hit(glm::dvec3 origin, glm::dvec3 direction) const;
    bool reaches(glm::dvec3 from, glm::dvec3 to) const;
    /// Of the lights, towards `view`; the highlight only where it is asked for.
    glm::dvec3 reflected(const Hit& hit, glm::dvec3 view, bool highlight) const;
    glm::dvec3 sky(glm::dvec3 direction) const;

    Scene scene_;
    std::vector<Shape> shapes_;
};

}  // namespace farfield
