#include "s2s/sonar/assignment.h"

#include <algorithm>
#include <functional>
#include <limits>
#include <queue>
#include <utility>

namespace s2s::sonar {

namespace {

constexpr int kNobody = -1;
constexpr double kSmallestStep = 1e-6;  // of the auction's prices, as a share of the unmatched cost

/// Edges by row: those of row i are at [begin[i], begin[i + 1]). Useless edges are left out.
struct RowGraph {
  struct Link {
    int column;
    double cost;
  };
  std::vector<std::size_t> begin;
  std::vector<Link> links;

  RowGraph(int rows, const std::vector<AssignmentEdge>& edges, double unmatchedCost) {
    begin.assign(static_cast<std::size_t>(rows) + 1, 0);
    for (const auto& e : edges)
      if (e.cost < unmatchedCost) ++begin[static_cast<std::size_t>(e.row) + 1];
    for (std::size_t i = 1; i < begin.size(); ++i) begin[i] += begin[i - 1];
    links.resize(begin.back());
    std::vector<std::size_t> next(begin.begin(), begin.end() - 1);
    for (const auto& e : edges)
      if (e.cost < unmatchedCost) links[next[static_cast<std::size_t>(e.row)]++] = {e.column, e.cost};
  }
};

/// Successive shortest paths. Each row also owns a private column "alone" at the unmatched cost.
class ShortestPathSolver {
 public:
  ShortestPathSolver(const AssignmentProblem& p, const RowGraph& graph)
      : graph_(graph),
        alone_(p.unmatchedCost),
        u_(static_cast<std::size_t>(p.rows), 0),
        v_(static_cast<std::size_t>(p.columns), 0),
        rowOf_(static_cast<std::size_t>(p.columns), kNobody),
        columnOf_(static_cast<std::size_t>(p.rows), kNobody),
        distance_(static_cast<std::size_t>(p.columns), kFar),
        from_(static_cast<std::size_t>(p.columns), kNobody),
        done_(static_cast<std::size_t>(p.columns), 0) {}

  std::vector<int> run() {
    for (int row = 0; row < static_cast<int>(columnOf_.size()); ++row) augment(row);
    return columnOf_;
  }

 private:
  static constexpr double kFar = std::numeric_limits<double>::infinity();
  using Entry = std::pair<double, int>;

  /// Follows the row's edges from distance `d`; also offers its private column as the end of the path.
  void relax(int row, double d) {
    const auto i = static_cast<std::size_t>(row);
    if (d + alone_ - u_[i] < endDistance_) {
      endDistance_ = d + alone_ - u_[i];
      endRow_ = row;
    }
    for (std::size_t k = graph_.begin[i]; k < graph_.begin[i + 1]; ++k) {
      const auto j = static_cast<std::size_t>(graph_.links[k].column);
      const double through = d + graph_.links[k].cost - u_[i] - v_[j];
      if (done_[j] != 0 || through >= distance_[j] || through >= endDistance_) continue;
      if (distance_[j] == kFar) touched_.push_back(graph_.links[k].column);
      distance_[j] = through;
      from_[j] = row;
      queue_.emplace(through, graph_.links[k].column);
    }
  }

  void augment(int start) {
    endDistance_ = kFar;
    endRow_ = kNobody;
    queue_ = {};
    relax(start, 0);
    int endColumn = kNobody;  // a free column, or kNobody: endRow_ retires to its private column
    while (!queue_.empty()) {
      const auto [d, column] = queue_.top();
      queue_.pop();
      const auto j = static_cast<std::size_t>(column);
      if (done_[j] != 0 || d > distance_[j]) continue;
      if (d >= endDistance_) break;
      if (rowOf_[j] == kNobody) {
        endDistance_ = d;
        endColumn = column;
        break;
      }
      done_[j] = 1;
      relax(rowOf_[j], d);
    }
    updatePotentials(start);
    shift(start, endColumn);
    for (const int column : touched_) {
      distance_[static_cast<std::size_t>(column)] = kFar;
      done_[static_cast<std::size_t>(column)] = 0;
    }
    touched_.clear();
  }

  void updatePotentials(int start) {
    u_[static_cast<std::size_t>(start)] += endDistance_;
    for (const int column : touched_) {
      const auto j = static_cast<std::size_t>(column);
      if (done_[j] == 0) continue;
      v_[j] -= endDistance_ - distance_[j];
      u_[static_cast<std::size_t>(rowOf_[j])] += endDistance_ - distance_[j];
    }
  }

  /// Moves every row on the path one column on.
  void shift(int start, int endColumn) {
    int column = endColumn;
    if (column == kNobody) {
      column = std::exchange(columnOf_[static_cast<std::size_t>(endRow_)], kNobody);
      if (endRow_ == start) return;
    }
    for (;;) {
      const int row = from_[static_cast<std::size_t>(column)];
      rowOf_[static_cast<std::size_t>(column)] = row;
      std::swap(columnOf_[static_cast<std::size_t>(row)], column);
      if (row == start) return;
    }
  }

  const RowGraph& graph_;
  double alone_;
  std::vector<double> u_, v_;
  std::vector<int> rowOf_, columnOf_;
  std::vector<double> distance_;
  std::vector<int> from_;
  std::vector<char> done_;
  std::vector<int> touched_;
  std::priority_queue<Entry, std::vector<Entry>, std::greater<>> queue_;
  double endDistance_ = kFar;
  int endRow_ = kNobody;
};

class Auction {
 public:
  Auction(const AssignmentProblem& p, const RowGraph& graph, double relativeGap)
      : graph_(graph),
        alone_(p.unmatchedCost),
        price_(static_cast<std::size_t>(p.columns), 0),
        rowOf_(static_cast<std::size_t>(p.columns), kNobody),
        columnOf_(static_cast<std::size_t>(p.rows), kNobody) {
    // With prices of zero every row takes its cheapest column: a first lower bound. A step of gap / rows keeps the sum
    // within the gap; the floor keeps rows of equal cost from bidding for ever.
    const double bound = lowerBound();
    step_ = std::max(relativeGap * bound / std::max(1, p.rows), kSmallestStep * alone_);
  }

  std::vector<int> run() {
    std::vector<int> waiting;
    for (int row = static_cast<int>(columnOf_.size()) - 1; row >= 0; --row) waiting.push_back(row);
    while (!waiting.empty()) {
      const int row = waiting.back();
      waiting.pop_back();
      const int loser = bid(row);
      if (loser != kNobody) waiting.push_back(loser);
    }
    return columnOf_;
  }

  /// Value of the dual problem at the present prices.
  double lowerBound() const {
    double sum = 0;
    for (std::size_t i = 0; i < columnOf_.size(); ++i) {
      double best = alone_;
      for (std::size_t k = graph_.begin[i]; k < graph_.begin[i + 1]; ++k)
        best = std::min(best, graph_.links[k].cost + price_[static_cast<std::size_t>(graph_.links[k].column)]);
      sum += best;
    }
    for (const double price : price_) sum -= price;
    return sum;
  }

 private:
  /// The row takes the column that suits it best and raises its price; returns who held it.
  int bid(int row) {
    const auto i = static_cast<std::size_t>(row);
    double best = alone_, second = alone_;
    int column = kNobody;
    for (std::size_t k = graph_.begin[i]; k < graph_.begin[i + 1]; ++k) {
      const double total = graph_.links[k].cost + price_[static_cast<std::size_t>(graph_.links[k].column)];
      if (total < best) {
        second = best;
        best = total;
        column = graph_.links[k].column;
      } else {
        second = std::min(second, total);
      }
    }
    if (column == kNobody) return kNobody;  // better off alone, for good: prices only rise
    const auto j = static_cast<std::size_t>(column);
    price_[j] += second - best + step_;
    columnOf_[i] = column;
    const int loser = std::exchange(rowOf_[j], row);
    if (loser != kNobody) columnOf_[static_cast<std::size_t>(loser)] = kNobody;
    return loser;
  }

  const RowGraph& graph_;
  double alone_;
  std::vector<double> price_;
  std::vector<int> rowOf_, columnOf_;
  double step_ = 0;
};

double costOf(const std::vector<int>& columnOfRow, const AssignmentProblem& p) {
  std::vector<double> cost(columnOfRow.size(), p.unmatchedCost);
  for (const auto& e : p.edges) {
    auto& c = cost[static_cast<std::size_t>(e.row)];
    if (columnOfRow[static_cast<std::size_t>(e.row)] == e.column) c = std::min(c, e.cost);
  }
  double sum = 0;
  for (const double c : cost) sum += c;
  return sum;
}

/// Rows and columns exchanged: bidders should be the few, else they outbid each other for long.
AssignmentProblem transposed(const AssignmentProblem& p) {
  AssignmentProblem t{p.columns, p.rows, p.edges, p.unmatchedCost};
  for (auto& e : t.edges) std::swap(e.row, e.column);
  return t;
}

Assignment transposedBack(const Assignment& a, const AssignmentProblem& p) {
  Assignment result;
  result.columnOfRow.assign(static_cast<std::size_t>(p.rows), kNobody);
  for (std::size_t column = 0; column < a.columnOfRow.size(); ++column)
    if (a.columnOfRow[column] != kNobody)
      result.columnOfRow[static_cast<std::size_t>(a.columnOfRow[column])] = static_cast<int>(column);
  result.cost = costOf(result.columnOfRow, p);
  // Both objectives differ by the constant number of rows times the unmatched cost.
  result.lowerBound = a.lowerBound + result.cost - a.cost;
  return result;
}

}  // namespace

Assignment assignOptimally(const AssignmentProblem& problem) {
  if (problem.rows > problem.columns) return transposedBack(assignOptimally(transposed(problem)), problem);
  const RowGraph graph(problem.rows, problem.edges, problem.unmatchedCost);
  Assignment result;
  result.columnOfRow = ShortestPathSolver(problem, graph).run();
  result.cost = result.lowerBound = costOf(result.columnOfRow, problem);
  return result;
}

Assignment assignByAuction(const AssignmentProblem& problem, double relativeGap) {
  if (problem.rows > problem.columns) return transposedBack(assignByAuction(transposed(problem), relativeGap), problem);
  const RowGraph graph(problem.rows, problem.edges, problem.unmatchedCost);
  Auction auction(problem, graph, relativeGap);
  Assignment result;
  result.columnOfRow = auction.run();
  result.cost = costOf(result.columnOfRow, problem);
  result.lowerBound = std::min(auction.lowerBound(), result.cost);
  return result;
}

Assignment assign(const AssignmentProblem& problem, const AssignmentOptions& options) {
  return problem.edges.size() <= options.optimalEdges ? assignOptimally(problem)
                                                      : assignByAuction(problem, options.relativeGap);
}

}  // namespace s2s::sonar
