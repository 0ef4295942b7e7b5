#pragma once
// The keys of a probe.

#include "poreshock/scene/scene.hpp"
#include "rules.hpp"

namespace poreshock::scene_text {

inline Names<ProbeKind> probe_kinds() {
  return {{"surface", ProbeKind::surface},
          {"interface", ProbeKind::interface},
          {"particle", ProbeKind::particle},
          {"point", ProbeKind::point}};
}

template <typename Visitor>
void visit_probe(Visitor& visitor, Probe& probe, const Scene& scene) {
  const Names<Facing> sides{{"up", Facing::up}, {"down", Facing::down}};
  const Names<Cadence> cadences{{"step", Cadence::step}, {"beat", Cadence::beat}};
  visitor.text("name", probe.name, {"its trace is probe_NAME.csv", Need::required});
  choice(visitor, "kind", probe.kind, probe_kinds(),
         {"a free surface or an interface as a velocimeter sees it, the material that starts at a "
          "place, or a point of space"});
  const bool surface = probe.kind == ProbeKind::surface;
  visitor.vector("at", probe.at, scene.dimension - (surface ? 1 : 0),
                 {any_number, "m",
                  "of a point in the laboratory, of others at the start; of a surface without the "
                  "height, of an interface at or a little outside its material",
                  Need::required});
  visitor.fallback(probe.width, scene.domain.cell);
  visitor.number("width", probe.width,
                 {positive, "m",
                  "of the spot that it averages over, at least and by default the "
                  "cell"});
  choice(visitor, "faces", probe.faces, sides,
         {"up: the material of a surface or an interface lies below it"});
  choice(visitor, "every", probe.every, cadences, {"one row per step or per output.beat"});
}

}  // namespace poreshock::scene_text
