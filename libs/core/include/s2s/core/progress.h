#pragma once

#include <chrono>
#include <iosfwd>
#include <string>

namespace s2s::core {

/// Progress of long work: share done, rate and time left, at most a line a period.
///
/// On a terminal the line is redrawn in place; elsewhere a new line is written each tenth of the work, but none of work
/// that is done within `quietFor`.
class Progress {
 public:
  /// @param out   where to write (usually std::cerr); a null pointer keeps silent
  /// @param label what is being done
  /// @param total amount of work in `unit`; zero or less if unknown
  /// @param unit  unit of the amount, e.g. "s" of survey: the rate is printed in it per second, for "s" as "x real
  /// time"
  Progress(std::ostream* out, std::string label, double total, std::string unit,
           std::chrono::milliseconds quietFor = std::chrono::seconds(1));
  ~Progress();
  Progress(const Progress&) = delete;
  Progress& operator=(const Progress&) = delete;

  /// Says how much is done in all; cheap enough for every record.
  void update(double done);
  /// Corrects the total, where it becomes known only on the way.
  void setTotal(double total) { total_ = total; }
  /// Ends the line. Called by the destructor too.
  void finish();

 private:
  using Clock = std::chrono::steady_clock;
  void print(double done, Clock::time_point now);

  std::ostream* out_;
  std::string label_, unit_;
  double total_, done_ = 0;
  std::chrono::milliseconds quietFor_;
  bool terminal_, finished_ = false;
  int lastTenth_ = -1;
  Clock::time_point start_, lastPrint_;
};

}  // namespace s2s::core
