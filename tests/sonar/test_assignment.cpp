#include <gtest/gtest.h>

#include <map>
#include <random>

#include "s2s/sonar/assignment.h"

namespace s2s::sonar {
namespace {

AssignmentProblem randomProblem(unsigned seed, int largest) {
  std::mt19937 random(seed);
  std::uniform_int_distribution<int> size(1, largest);
  AssignmentProblem p;
  p.rows = size(random);
  p.columns = size(random);
  p.unmatchedCost = 1.0;
  std::uniform_real_distribution<double> cost(0, 1.3), chance(0, 1);
  const double density = std::uniform_real_distribution<double>(0.05, 1.0)(random);
  for (int r = 0; r < p.rows; ++r)
    for (int c = 0; c < p.columns; ++c)
      if (chance(random) < density) {
        // Every fourth problem has few distinct costs, so that many assignments tie.
        const double x = cost(random);
        p.edges.push_back({r, c, seed % 4 == 0 ? std::round(x * 4) / 4 : x});
      }
  return p;
}

std::map<std::pair<int, int>, double> costs(const AssignmentProblem& p) {
  std::map<std::pair<int, int>, double> table;
  for (const auto& e : p.edges) table[{e.row, e.column}] = e.cost;
  return table;
}

/// One to one, only along edges, and worth what it says.
void expectValid(const AssignmentProblem& p, const Assignment& a) {
  const auto table = costs(p);
  ASSERT_EQ(a.columnOfRow.size(), static_cast<std::size_t>(p.rows));
  std::vector<int> used(static_cast<std::size_t>(p.columns), 0);
  double sum = 0;
  for (int r = 0; r < p.rows; ++r) {
    const int c = a.columnOfRow[static_cast<std::size_t>(r)];
    if (c < 0) {
      sum += p.unmatchedCost;
      continue;
    }
    ASSERT_TRUE(table.count({r, c}) == 1) << "row " << r << " has no edge to column " << c;
    EXPECT_EQ(used[static_cast<std::size_t>(c)]++, 0) << "column " << c << " is used twice";
    sum += table.at({r, c});
  }
  EXPECT_NEAR(a.cost, sum, 1e-9);
}

/// All assignments tried, for tiny problems.
double bestByTrying(const AssignmentProblem& p, const std::map<std::pair<int, int>, double>& table, int row,
                    std::vector<char>& used) {
  if (row == p.rows) return 0;
  double best = p.unmatchedCost + bestByTrying(p, table, row + 1, used);
  for (int c = 0; c < p.columns; ++c) {
    const auto edge = table.find({row, c});
    if (used[static_cast<std::size_t>(c)] != 0 || edge == table.end()) continue;
    used[static_cast<std::size_t>(c)] = 1;
    best = std::min(best, edge->second + bestByTrying(p, table, row + 1, used));
    used[static_cast<std::size_t>(c)] = 0;
  }
  return best;
}

TEST(Assignment, TinyProblems_OptimumEqualsTryingAll) {
  for (unsigned seed = 1; seed <= 200; ++seed) {
    const auto p = randomProblem(seed, 6);
    std::vector<char> used(static_cast<std::size_t>(p.columns), 0);
    const auto a = assignOptimally(p);
    expectValid(p, a);
    EXPECT_NEAR(a.cost, bestByTrying(p, costs(p), 0, used), 1e-9) << "problem " << seed;
  }
}

TEST(Assignment, RandomProblems_AuctionIsWithinOnePercent) {
  for (unsigned seed = 1; seed <= 200; ++seed) {
    const auto p = randomProblem(seed, 80);
    const auto best = assignOptimally(p), quick = assignByAuction(p, 0.01);
    expectValid(p, best);
    expectValid(p, quick);
    EXPECT_GE(quick.cost, best.cost - 1e-9) << "problem " << seed;
    // An optimum of zero leaves no room for a share of it: the auction's smallest step is the rest, once a row.
    const double smallest = 1e-6 * p.unmatchedCost * std::min(p.rows, p.columns);
    EXPECT_LE(quick.cost, 1.01 * best.cost + smallest + 1e-9) << "problem " << seed;
    EXPECT_LE(quick.lowerBound, best.cost + 1e-9) << "the proof must hold, problem " << seed;
    // The proof itself is as tight as asked: that is what "proven close" means.
    EXPECT_LE(quick.cost - quick.lowerBound, 0.01 * best.cost + smallest + 1e-9) << "problem " << seed;
  }
}

TEST(Assignment, ManyRowsForFewEqualColumns_AuctionEnds) {
  AssignmentProblem p;
  p.rows = 300;
  p.columns = 3;
  for (int r = 0; r < p.rows; ++r)
    for (int c = 0; c < p.columns; ++c) p.edges.push_back({r, c, 0.25});
  const auto a = assignByAuction(p, 0.01);
  expectValid(p, a);
  EXPECT_NEAR(a.cost, 3 * 0.25 + 297, 1e-9);
}

TEST(Assignment, ExpensiveEdges_AreNotUsed) {
  const AssignmentProblem p{2, 2, {{0, 0, 1.5}, {1, 1, 0.5}}, 1.0};
  for (const auto& a : {assignOptimally(p), assignByAuction(p, 0.01)}) {
    EXPECT_EQ(a.columnOfRow, (std::vector<int>{-1, 1}));
    EXPECT_DOUBLE_EQ(a.cost, 1.5);
  }
}

TEST(Assignment, EmptyProblems_AreSolved) {
  EXPECT_TRUE(assignOptimally({}).columnOfRow.empty());
  const AssignmentProblem noEdges{2, 3, {}, 1.0};
  EXPECT_EQ(assignOptimally(noEdges).columnOfRow, (std::vector<int>{-1, -1}));
  EXPECT_EQ(assignByAuction(noEdges, 0.01).columnOfRow, (std::vector<int>{-1, -1}));
}

}  // namespace
}  // namespace s2s::sonar
