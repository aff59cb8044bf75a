#pragma once

#include <array>
#include <cmath>
#include <cstdint>
#include <memory>
#include <unordered_map>

namespace s2s::map {

/// A horizontal grid of cells without bounds; only blocks of 16 x 16 cells that were written to take memory.
template <class Cell>
class SparseGrid {
 public:
  explicit SparseGrid(double cell_m) : cell_m_(cell_m) {}
  SparseGrid(const SparseGrid& other) : cell_m_(other.cell_m_) {
    for (const auto& [key, block] : other.blocks_) blocks_.emplace(key, std::make_unique<Block>(*block));
  }
  SparseGrid& operator=(const SparseGrid& other) {
    if (this == &other) return *this;
    SparseGrid copy(other);
    return *this = std::move(copy);
  }
  SparseGrid(SparseGrid&&) noexcept = default;
  SparseGrid& operator=(SparseGrid&&) noexcept = default;
  ~SparseGrid() = default;

  double cell_m() const { return cell_m_; }
  /// Index of the cell in which a coordinate lies; cell i covers [i, i + 1) * cell_m.
  std::int32_t index(double coordinate_m) const {
    return static_cast<std::int32_t>(std::floor(coordinate_m / cell_m_));
  }

  /// The cell, made if it does not exist yet.
  Cell& at(std::int32_t ix, std::int32_t iy) {
    std::unique_ptr<Block>& block = blocks_[blockKey(ix, iy)];
    if (!block) block = std::make_unique<Block>();
    return (*block)[cellInBlock(ix, iy)];
  }

  /// Null if nothing was written near. `hint` remembers the block of the last look-up: neighbouring places cost no
  /// search.
  struct Hint {
    std::uint64_t key = ~std::uint64_t{0};
    const void* block = nullptr;
  };
  const Cell* find(std::int32_t ix, std::int32_t iy, Hint& hint) const {
    const std::uint64_t key = blockKey(ix, iy);
    if (hint.key != key) {
      const auto found = blocks_.find(key);
      hint = {key, found == blocks_.end() ? nullptr : found->second.get()};
    }
    return hint.block ? &(*static_cast<const Block*>(hint.block))[cellInBlock(ix, iy)] : nullptr;
  }

 private:
  static constexpr std::int32_t kBits = 4;
  static constexpr std::int32_t kMask = (1 << kBits) - 1;
  using Block = std::array<Cell, std::size_t{1} << (2 * kBits)>;

  static std::uint64_t blockKey(std::int32_t ix, std::int32_t iy) {
    // The shift of a negative index rounds down, as it must.
    return (static_cast<std::uint64_t>(static_cast<std::uint32_t>(ix >> kBits)) << 32) |
           static_cast<std::uint32_t>(iy >> kBits);
  }
  static std::size_t cellInBlock(std::int32_t ix, std::int32_t iy) {
    return static_cast<std::size_t>(((ix & kMask) << kBits) | (iy & kMask));
  }

  double cell_m_;
  std::unordered_map<std::uint64_t, std::unique_ptr<Block>> blocks_;
};

}  // namespace s2s::map
