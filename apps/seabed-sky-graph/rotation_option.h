#pragma once

#include <CLI/CLI.hpp>
#include <map>
#include <string>

#include "s2s/graph/graph_io.h"

namespace s2s::apps {

/// The option --g2o-rotation of all subcommands.
inline void addRotationOption(CLI::App& app, graph::G2oRotation& rotation) {
  static const std::map<std::string, graph::G2oRotation> kWords{{"quaternion", graph::G2oRotation::quaternion},
                                                                {"angle", graph::G2oRotation::angle}};
  app.add_option("--g2o-rotation", rotation,
                 "What the information of an EDGE_SE3:QUAT weighs: 'quaternion', the vector part of the error "
                 "quaternion, as g2o does (default), or 'angle', the rotation vector, as GTSAM and Ceres' example do")
      ->transform(CLI::CheckedTransformer(kWords))
      ->option_text("WORD");
}

}  // namespace s2s::apps
