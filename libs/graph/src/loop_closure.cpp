#include "s2s/graph/loop_closure.h"

namespace s2s::graph {

const char* closureSourceName(ClosureSource source) {
  switch (source) {
    case ClosureSource::proximity:
      return "proximity";
    case ClosureSource::descriptor:
      return "descriptor";
    case ClosureSource::external:
      return "external";
    case ClosureSource::priorMap:
      return "prior map";
    case ClosureSource::injected:
      return "injected";
  }
  return "?";
}

const char* closureStatusText(ClosureStatus status) {
  switch (status) {
    case ClosureStatus::accepted:
      return "accepted";
    case ClosureStatus::pending:
      return "waits for a second closure that agrees";
    case ClosureStatus::rejectedOverlap:
      return "too little overlap";
    case ClosureStatus::rejectedResidual:
      return "the clouds do not fit";
    case ClosureStatus::rejectedDegenerate:
      return "the surroundings do not determine the pose";
    case ClosureStatus::rejectedByOdometry:
      return "contradicts the odometry";
    case ClosureStatus::rejectedByOthers:
      return "contradicts other closures";
    case ClosureStatus::rejectedByOptimiser:
      return "contradicts the optimised graph";
  }
  return "?";
}

}  // namespace s2s::graph
