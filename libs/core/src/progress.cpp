#include "s2s/core/progress.h"

#include <unistd.h>

#include <algorithm>
#include <cstdio>
#include <ostream>

#include "s2s/core/time.h"

namespace s2s::core {

namespace {

constexpr std::chrono::milliseconds kRedrawPeriod{200};
constexpr std::chrono::seconds kLinePeriod{10};  // for work of unknown size that is not on a terminal

}  // namespace

Progress::Progress(std::ostream* out, std::string label, double total, std::string unit,
                   std::chrono::milliseconds quietFor)
    : out_(out),
      label_(std::move(label)),
      unit_(std::move(unit)),
      total_(total),
      quietFor_(quietFor),
      terminal_(::isatty(STDERR_FILENO) != 0),
      start_(Clock::now()),
      lastPrint_(start_) {}

Progress::~Progress() { finish(); }

void Progress::update(double done) {
  done_ = done;
  if (!out_) return;
  const auto now = Clock::now();
  if (terminal_) {
    if (now - lastPrint_ >= kRedrawPeriod) print(done, now);
    return;
  }
  if (now - start_ < quietFor_) return;
  if (total_ > 0) {
    const int tenth = static_cast<int>(10 * done / total_);
    if (tenth > lastTenth_ && tenth > 0) {
      lastTenth_ = tenth;
      print(done, now);
    }
  } else if (now - lastPrint_ >= kLinePeriod) {
    print(done, now);
  }
}

void Progress::print(double done, Clock::time_point now) {
  lastPrint_ = now;
  const double elapsed_s = std::chrono::duration<double>(now - start_).count();
  const double rate = elapsed_s > 0 ? done / elapsed_s : 0;
  char text[200];
  int n = 0;
  if (total_ > 0)
    n = std::snprintf(text, sizeof text, "%s: %3.0f %%", label_.c_str(), 100 * done / total_);
  else
    n = std::snprintf(text, sizeof text, "%s: %.0f %s", label_.c_str(), done, unit_.c_str());
  std::string line(text, static_cast<std::size_t>(n));
  if (unit_ == "s")
    std::snprintf(text, sizeof text, ", %.2f x real time", rate);
  else
    std::snprintf(text, sizeof text, ", %.1f %s/s", rate, unit_.c_str());
  line += text;
  if (total_ > 0 && rate > 0) line += ", " + formatDuration(std::max(0.0, total_ - done) / rate) + " left";
  if (terminal_)
    *out_ << "\r\033[K" << line << std::flush;
  else
    *out_ << line << '\n' << std::flush;
}

void Progress::finish() {
  if (finished_) return;
  finished_ = true;
  if (!out_ || !terminal_) return;
  print(done_, Clock::now());
  *out_ << '\n' << std::flush;
}

}  // namespace s2s::core
