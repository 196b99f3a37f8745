#include "tests/path_tracer.h"

#include <glm/geometric.hpp>
#include <glm/trigonometric.hpp>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <stdexcept>

namespace farfield {
namespace {

constexpr double pi = std::numbers::pi;
constexpr double offset = 1e-7;  // metres; rays that leave a surface start so far above it

struct Crossing {
    double distance;
    glm::dvec3 normal;
};

/// Where a ray enters a convex body: the last of its entries into the slabs |x_i| <= half_i, before all exits.
std::optional<Crossing> enter_box(glm::dvec3 half, glm::dvec3 o, glm::dvec3 d) {
    double enter = 0.0, leave = 1e30;
    glm::dvec3 normal(0.0);
    for (int i = 0; i < 3; ++i) {
        if (d[i] == 0.0) {
            if (std::abs(o[i]) > half[i]) return std::nullopt;
            continue;
        }
        const double side = d[i] > 0.0 ? 1.0 : -1.0;
        const double t = (-side * half[i] - o[i]) / d[i];
        leave = std::min(leave, (side * half[i] - o[i]) / d[i]);
        if (t > enter) {
            enter = t;
            normal = glm::dvec3(0.0);
            normal[i] = -side;
        }
    }
    return enter > 0.0 && enter <= leave ? std::optional<Crossing>({enter, normal}) : std::nullopt;
}

/// Of |v| <= radius for v = o + t d, where o and d may lie in a plane: entry and exit.
std::optional<std::pair<double, double>> round_interval(double radius, glm::dvec3 o, glm::dvec3 d) {
    const double a = glm::dot(d, d), b = glm::dot(o, d), root = b * b - a * (glm::dot(o, o) - radius * radius);
    if (root < 0.0 || a == 0.0) return std::nullopt;
    return std::pair((-b - std::sqrt(root)) / a, (-b + std::sqrt(root)) / a);
}

std::optional<Crossing> enter_sphere(double radius, glm::dvec3 o, glm::dvec3 d) {
    const auto interval = round_interval(radius, o, d);
    if (!interval || interval->first <= 0.0) return std::nullopt;
    return Crossing{interval->first, (o + interval->first * d) / radius};
}

std::optional<Crossing> enter_cylinder(double radius, double half_height, glm::dvec3 o, glm::dvec3 d) {
    const auto side = round_interval(radius, {o.x, 0.0, o.z}, {d.x, 0.0, d.z});
    if (!side || d.y == 0.0) return std::nullopt;  // a ray along or across the axis has probability 0
    const double one = (-half_height - o.y) / d.y, other = (half_height - o.y) / d.y;
    const double caps = std::min(one, other), t = std::max(side->first, caps);
    if (t <= 0.0 || t > std::min(side->second, std::max(one, other))) return std::nullopt;
    const glm::dvec3 p = o + t * d;
    return Crossing{
        t, side->first > caps ? glm::dvec3(p.x, 0.0, p.z) / radius : glm::dvec3(0.0, d.y > 0.0 ? -1.0 : 1.0, 0.0)};
}

/// The rotation about x, then y, then z.
glm::dmat3 rotation(glm::dvec3 degrees) {
    const glm::dvec3 c = glm::cos(glm::radians(degrees)), s = glm::sin(glm::radians(degrees));
    const glm::dmat3 x(1, 0, 0, 0, c.x, s.x, 0, -s.x, c.x), y(c.y, 0, -s.y, 0, 1, 0, s.y, 0, c.y),
        z(c.z, s.z, 0, -s.z, c.z, 0, 0, 0, 1);
    return z * y * x;
}

/// A unit normal plus a point of the unit sphere: its direction has density cos / pi.
glm::dvec3 diffuse_direction(glm::dvec3 normal, std::mt19937_64& random) {
    std::uniform_real_distribution<double> uniform(0.0, 1.0);
    const double y = 2.0 * uniform(random) - 1.0, angle = 2.0 * pi * uniform(random), r = std::sqrt(1.0 - y * y);
    return glm::normalize(normal + glm::dvec3(r * std::cos(angle), y, r * std::sin(angle)));
}

}  // namespace

PathTracer::PathTracer(const Scene& scene) : scene_(scene) {
    for (const Node& node : scene_.root.children) {
        const glm::dvec3 first(node.values.at(0));
        glm::dvec3 extent;
        if (node.kind == NodeKind::box)
            extent = first;
        else if (node.kind == NodeKind::sphere)
            extent = glm::dvec3(first.x);
        else if (node.kind == NodeKind::capped_cylinder)
            extent = {first.x, node.values.at(1).x, first.x};
        else
            throw std::invalid_argument("the path tracer does not know the shape");
        if (node.transform.scale != 1.0f) throw std::invalid_argument("the path tracer does not know scales");
        shapes_.push_back({node.kind, extent, node.transform.translate, rotation(node.transform.rotate),
                           &scene_.materials[material_index(scene_, node.material, 0)]});
    }
}

std::optional<PathTracer::Hit> PathTracer::first_hit(glm::dvec3 origin, glm::dvec3 direction) const {
    std::optional<Hit> first;
    for (const Shape& shape : shapes_) {
        const glm::dvec3 o = (origin - shape.centre) * shape.to_world, d = direction * shape.to_world;
        const std::optional<Crossing> crossing = shape.kind == NodeKind::box ? enter_box(shape.extent, o, d)
                                                 : shape.kind == NodeKind::sphere
                                                     ? enter_sphere(shape.extent.x, o, d)
                                                     : enter_cylinder(shape.extent.x, shape.extent.y, o, d);
        if (crossing && (!first || crossing->distance < first->distance))
            first = Hit{crossing->distance, origin + crossing->distance * direction, shape.to_world * crossing->normal,
                        shape.material};
    }
    return first;
}

bool PathTracer::reaches(glm::dvec3 from, glm::dvec3 to) const {
    const double distance = glm::distance(from, to);
    const std::optional<Hit> hit = first_hit(from, (to - from) / distance);
    return !hit || hit->distance >= distance;
}

glm::dvec3 PathTracer::reflected(const Hit& hit, glm::dvec3 view, bool highlight) const {
    glm::dvec3 sum(0.0);
    const glm::dvec3 above = hit.position + offset * hit.normal;
    for (const Light& light : scene_.lights) {
        const bool point = light.kind == LightKind::point;
        const glm::dvec3 to_light =
            point ? glm::dvec3(light.position) - above : -glm::normalize(glm::dvec3(light.direction));
        const glm::dvec3 direction = glm::normalize(to_light);
        const double cosine = glm::dot(hit.normal, direction);
        if (cosine <= 0.0 || !reaches(above, above + (point ? to_light : 1e3 * direction))) continue;
        const Material& m = *hit.material;
        const double mirrored = std::max(glm::dot(2.0 * cosine * hit.normal - direction, view), 0.0);
        const double lobe =
            highlight ? m.specular * (m.exponent + 2.0) / (2.0 * pi) * std::pow(mirrored, m.exponent) : 0.0;
        const double falloff = point ? 1.0 / glm::dot(to_light, to_light) : 1.0;
        sum += glm::dvec3(light.intensity) * cosine * falloff * (glm::dvec3(m.albedo) / pi + lobe);
    }
    return sum;
}

glm::dvec3 PathTracer::sky(glm::dvec3 direction) const {
    const double share = std::clamp(direction.y, 0.0, 1.0);
    return (1.0 - share) * glm::dvec3(scene_.sky.horizon) + share * glm::dvec3(scene_.sky.zenith);
}

glm::dvec3 PathTracer::sample(int x, int y, int size, std::mt19937_64& random) const {
    std::uniform_real_distribution<double> uniform(0.0, 1.0);
    const glm::dvec3 forward = glm::normalize(glm::dvec3(scene_.camera.target) - glm::dvec3(scene_.camera.position));
    const glm::dvec3 right = glm::normalize(glm::cross(forward, glm::dvec3(0.0, 1.0, 0.0)));
    const double half = std::tan(glm::radians(0.5 * scene_.camera.field_of_view));
    const double u = 2.0 * (x + uniform(random)) / size - 1.0, v = 1.0 - 2.0 * (y + uniform(random)) / size;
    glm::dvec3 origin = scene_.camera.position;
    glm::dvec3 direction = glm::normalize(forward + half * (u * right + v * glm::cross(right, forward)));

    glm::dvec3 radiance(0.0), throughput(1.0);
    for (int bounce = 0; bounce <= scene_.settings.bounces; ++bounce) {
        const std::optional<Hit> hit = first_hit(origin, direction);
        if (!hit) return radiance + throughput * sky(direction);
        radiance += throughput * (glm::dvec3(hit->material->emission) + reflected(*hit, -direction, bounce == 0));
        throughput *= glm::dvec3(hit->material->albedo);
        origin = hit->position + offset * hit->normal;
        direction = diffuse_direction(hit->normal, random);
    }
    return radiance;
}

}  // namespace farfield
