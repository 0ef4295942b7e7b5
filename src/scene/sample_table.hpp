#pragma once
// The keys of what is filled with material: the generated sample, bodies and voids.

#include "poreshock/scene/scene.hpp"
#include "rules.hpp"

namespace poreshock::scene_text {

/// Index of a material by its name; the first material by default.
template <typename Visitor>
void visit_material_name(Visitor& visitor, int& index, const Scene& scene) {
  Names<int> names;
  for (int i = 0; i < static_cast<int>(scene.materials.size()); ++i) {
    // A material whose name is wrong has none, and has been reported.
    if (!scene.materials[i].name.empty()) names.emplace_back(scene.materials[i].name, i);
  }
  choice(visitor, "material", index, names, {"name of a material, by default the first"});
}

template <typename Visitor>
void visit_image(Visitor& visitor, Sample& sample, int dimension) {
  const Names<Regions> fates{{"grains", Regions::grains}, {"matrix", Regions::matrix}};
  visitor.text("image", sample.image,
               {"picture, or in 3-D stack of slices, relative to the scene's folder"});
  visitor.number("pixel", sample.pixel,
                 {not_negative, "m", "side of a pixel or voxel of the image"});
  visitor.number("threshold", sample.threshold,
                 {any_number, "", "grey value from which on a pixel is solid; without: labels"});
  choice(visitor, "regions", sample.regions, fates,
         {"of an image: a grain each, or all one solid with voids in it"});
  visitor.vector("raw_size", sample.raw_size, dimension,
                 {not_negative, "", "voxels along each axis of an image that is plain numbers"});
  visitor.name("raw_type", sample.raw_type,
               {"uint8", "int8", "uint16", "int16", "uint32", "int32", "float32", "float64"},
               {"of its numbers"});
  visitor.flag("raw_big_endian", sample.raw_big_endian,
               {"true where its numbers have their highest byte first"});
  integer(visitor, "raw_skip", sample.raw_skip, {not_negative, "", "bytes before its numbers"});
}

template <typename Visitor>
void visit_grains(Visitor& visitor, Sample& sample, const Scene& scene) {
  visitor.number("grain_radius", sample.grain_radius,
                 {not_negative, "m", "median radius of a grain; Voronoi: of the equal disc"});
  visitor.number("grain_spread", sample.grain_spread,
                 {not_negative, "", "standard deviation of ln(radius); 0 = all equal"});
  visitor.number("grain_gap", sample.grain_gap,
                 {not_negative, "m", "least gap between two packed grains"});
  visit_image(visitor, sample, scene.dimension);
  visitor.tables("mixture", sample.mixture, {"A material of the grains."},
                 [&](auto& inner, MixturePart& part) {
                   visit_material_name(inner, part.material, scene);
                   inner.number("fraction", part.fraction,
                                {{.low = 0.0, .high = 1.0, .above_low = true},
                                 "",
                                 "share of the volume of all grains",
                                 Need::required});
                 });
}

template <typename Visitor>
void visit_sample(Visitor& visitor, Scene& scene) {
  Sample& sample = scene.sample;
  const Names<SampleKind> kinds{{"none", SampleKind::none},
                                {"solid", SampleKind::solid},
                                {"random_voids", SampleKind::random_voids},
                                {"packed_grains", SampleKind::packed_grains},
                                {"voronoi_grains", SampleKind::voronoi_grains},
                                {"image", SampleKind::image}};
  const Names<Islands> fates{{"removed", Islands::removed}, {"grains", Islands::grains}};
  const Names<PorosityDefinition> definitions{
      {"void_fraction", PorosityDefinition::void_fraction},
      {"distension_minus_1", PorosityDefinition::distension_minus_1}};
  choice(visitor, "kind", sample.kind, kinds, {"a block over the whole width, from the bottom up"});
  visit_material_name(visitor, sample.material, scene);
  visitor.fallback(sample.height, scene.domain.size[scene.dimension - 1]);
  visitor.number("height", sample.height, {positive, "m", "by default that of the domain"});
  visitor.number("porosity", sample.porosity, {not_negative, "", "share of the voids"});
  choice(visitor, "porosity_definition", sample.porosity_definition, definitions,
         {"void volume over all volume, or over solid volume"});
  visitor.number("void_radius", sample.void_radius, {not_negative, "m", "median radius of a void"});
  visitor.number(
      "void_spread", sample.void_spread,
      {{.low = 0.0, .high = 2.0}, "", "standard deviation of ln(radius); 0 = all equal"});
  visitor.number("ligament", sample.ligament,
                 {not_negative, "m", "least solid between two voids; not with overlap"});
  visitor.number("keep_out", sample.keep_out,
                 {not_negative, "m", "least solid between a void and bottom or top"});
  visitor.flag("overlap", sample.overlap, {"true where voids may overlap"});
  choice(visitor, "islands", sample.islands, fates,
         {"what becomes of pieces that overlapping voids cut off"});
  visit_grains(visitor, sample, scene);
  integer(visitor, "seed", sample.seed, {not_negative, "", "of the random placement"});
  integer(visitor, "particles_per_cell", sample.particles_per_cell,
          {{.low = 1.0, .high = 8.0}, "", "per direction, bodies too"});
}

inline Names<BodyShape> shape_names(int dimension) {
  if (dimension == 3) {
    return {{"ball", BodyShape::disc}, {"box", BodyShape::box}, {"shell", BodyShape::ring}};
  }
  return {{"disc", BodyShape::disc},
          {"box", BodyShape::box},
          {"ring", BodyShape::ring},
          {"polygon", BodyShape::polygon}};
}

template <typename Visitor>
void visit_region(Visitor& visitor, Region& region, int dimension) {
  const Rule rule{"the keys that follow depend on it", Need::required};
  if (!choice(visitor, "shape", region.shape, shape_names(dimension), rule)) {
    visitor.skip_unknown();
    return;
  }
  const bool ring = region.shape == BodyShape::ring;
  if (ring || region.shape == BodyShape::disc) {
    visitor.vector("center", region.center, dimension, {any_number, "m", "", Need::required});
  }
  if (region.shape == BodyShape::disc) {
    visitor.number("radius", region.radius, {positive, "m", "", Need::required});
  } else if (ring) {
    visitor.number("inner", region.inner_radius, {positive, "m", "inner radius", Need::required});
    visitor.number("outer", region.radius, {positive, "m", "outer radius", Need::required});
  } else if (region.shape == BodyShape::box) {
    visitor.vector("low", region.low, dimension, {any_number, "m", "corner", Need::required});
    visitor.vector("high", region.high, dimension,
                   {any_number, "m", "opposite corner", Need::required});
  } else {
    visitor.points("points", region.points,
                   {any_number, "m", "corners in order around it", Need::required});
  }
}

template <typename Visitor>
void visit_body(Visitor& visitor, Body& body, const Scene& scene) {
  visit_region(visitor, body.region, scene.dimension);
  visit_material_name(visitor, body.material, scene);
  integer(visitor, "grain", body.grain,
          {{.low = 0.0, .high = 1e6}, "", "number of the grain it belongs to"});
  visitor.vector("velocity", body.velocity, scene.dimension,
                 {any_number, "m/s", "added to the loading velocity"});
  const NumberRule spin{any_number, "rad/s", "about the centroid"};
  if (scene.dimension == 3) {
    visitor.vector("spin", body.spin, 3, spin);
  } else {
    visitor.number("spin", body.spin[2], spin);
  }
}

}  // namespace poreshock::scene_text
