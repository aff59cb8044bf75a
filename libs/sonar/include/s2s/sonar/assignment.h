#pragma once

#include <cstddef>
#include <vector>

namespace s2s::sonar {

/// A row and a column may be matched at a cost.
struct AssignmentEdge {
  int row = 0;
  int column = 0;
  double cost = 0;  ///< not negative
};

/// One-to-one matching of rows with columns along given edges. The objective is the sum of the matched costs plus
/// `unmatchedCost` for each row left alone, so an edge at or above that cost is never used.
struct AssignmentProblem {
  int rows = 0;
  int columns = 0;
  std::vector<AssignmentEdge> edges;
  double unmatchedCost = 1;
};

struct AssignmentOptions {
  /// Problems with at most this many edges are solved optimally, larger ones by the auction.
  std::size_t optimalEdges = 5000;
  /// The auction's goal: cost above the optimum, as a share of a lower bound of the optimum.
  double relativeGap = 0.01;  // plus at most 1e-6 of the unmatched cost for each row
};

struct Assignment {
  std::vector<int> columnOfRow;  ///< -1 for a row left alone
  double cost = 0;               ///< value of the objective
  double lowerBound = 0;         ///< proven: no assignment costs less; equal to `cost` when it is optimal
};

/// Optimal, by successive shortest augmenting paths with potentials on the sparse graph.
Assignment assignOptimally(const AssignmentProblem& problem);

/// Greedy with prices (Bertsekas' auction): rows bid for columns until nobody can gain more than a small step. The
/// final prices prove how far the cost can be from the optimum; `lowerBound` states it.
Assignment assignByAuction(const AssignmentProblem& problem, double relativeGap);

/// The one or the other by the size of the problem.
Assignment assign(const AssignmentProblem& problem, const AssignmentOptions& options);

}  // namespace s2s::sonar
