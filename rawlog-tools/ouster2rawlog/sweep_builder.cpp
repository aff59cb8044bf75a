#include "ouster2rawlog/sweep_builder.h"

#include <algorithm>
#include <cmath>

namespace s2s::tools::ouster {

namespace {

constexpr double kRadPerDeg = M_PI / 180.0;
/// Columns of one sweep are within a turn of each other; a second is far beyond the slowest (5 Hz).
constexpr std::int64_t kMaxSweep_ns = core::kNsPerSecond;

obs::CObservationLidarSweep geometryOf(const Metadata& metadata, const LidarPacketFormat& format,
                                       std::uint32_t firstColumn, std::uint32_t columnCount) {
  obs::CObservationLidarSweep sweep;
  sweep.sensorModel = metadata.model;
  sweep.rowCount = metadata.rows;
  sweep.columnCount = columnCount;
  sweep.rangeResolution_m = 0.001;
  for (std::size_t row = 0; row < metadata.rows; ++row) {
    sweep.beamAltitude_rad.push_back(static_cast<float>(kRadPerDeg * metadata.beamAltitude_deg[row]));
    sweep.beamAzimuth_rad.push_back(static_cast<float>(-kRadPerDeg * metadata.beamAzimuth_deg[row]));
  }
  sweep.beamOriginOffset_m = metadata.beamOriginOffset_m;
  sweep.beamOriginHeight_m = metadata.beamOriginHeight_m;
  sweep.T_sensor_lidar = core::toPose(metadata.T_sensor_lidar);
  for (std::uint32_t column = 0; column < columnCount; ++column)
    sweep.columnAzimuth_rad.push_back(static_cast<float>(-2 * M_PI * (firstColumn + column) / metadata.columns));
  sweep.echoes.resize(format.profile().echoes.size());
  return sweep;
}

void allocate(obs::CObservationLidarSweep& sweep, const LidarProfile& profile) {
  const std::size_t pixels = sweep.pixelCount();
  for (std::size_t i = 0; i < profile.echoes.size(); ++i) {
    auto& echo = sweep.echoes[i];
    echo.range.assign(pixels, 0);
    if (profile.echoes[i].reflectivity.exists()) echo.reflectivity.assign(pixels, 0);
    if (profile.echoes[i].signal.exists()) echo.signal.assign(pixels, 0);
    if (profile.echoes[i].flags.exists()) echo.flags.assign(pixels, 0);
  }
  if (profile.nearInfrared.exists()) sweep.nearInfrared.assign(pixels, 0);
  sweep.columnValid.assign(sweep.columnCount, 0);
}

bool allZero(const std::vector<std::uint8_t>& values) {
  return std::all_of(values.begin(), values.end(), [](std::uint8_t value) { return value == 0; });
}

}  // namespace

SweepBuilder::SweepBuilder(const Metadata& metadata, const LidarPacketFormat& format, std::int64_t timeOffset_ns,
                           bool ownClock)
    : metadata_(metadata), format_(format), timeOffset_ns_(timeOffset_ns), ownClock_(ownClock) {
  const bool spansZero = metadata.firstColumn > metadata.lastColumn;
  firstColumn_ = spansZero ? 0 : metadata.firstColumn;
  columnCount_ = spansZero ? metadata.columns : metadata.lastColumn - metadata.firstColumn + 1;
  prototype_ = geometryOf(metadata, format, firstColumn_, columnCount_);
}

obs::CObservationLidarSweep::Ptr SweepBuilder::add(const std::uint8_t* packet) {
  const std::uint32_t frameId = format_.header(packet).frameId;
  if (!sweep_ && frameId == finishedFrameId_) {
    statistics_.lateColumns += format_.columnsPerPacket();
    return nullptr;
  }
  obs::CObservationLidarSweep::Ptr finished;
  if (sweep_ && frameId != sweep_->frameId) {
    if (frameId == finishedFrameId_) {
      statistics_.lateColumns += format_.columnsPerPacket();
      return nullptr;
    }
    finished = finish();
  }
  if (!sweep_) begin(frameId);
  for (std::uint32_t column = 0; column < format_.columnsPerPacket(); ++column) addColumn(packet, column);
  return finished;
}

void SweepBuilder::begin(std::uint32_t frameId) {
  sweep_ = obs::CObservationLidarSweep::Create(prototype_);
  sweep_->frameId = frameId;
  allocate(*sweep_, format_.profile());
  columnTime_ns_.assign(columnCount_, 0);
  firstTime_ns_ = -1;
}

void SweepBuilder::addColumn(const std::uint8_t* packet, std::uint32_t packetColumn) {
  const ColumnHeader header = format_.column(packet, packetColumn);
  if (!header.valid) return;
  const std::uint32_t column = header.measurementId - firstColumn_;  // wraps to a large number before the window
  if (column >= columnCount_ || header.time_ns > kLatestDeviceTime_ns) {
    ++statistics_.impossibleColumns;
    return;
  }
  const auto time_ns = static_cast<std::int64_t>(header.time_ns);
  if (firstTime_ns_ < 0) firstTime_ns_ = time_ns;
  if (std::abs(time_ns - firstTime_ns_) > kMaxSweep_ns) {
    ++statistics_.impossibleColumns;
    return;
  }
  columnTime_ns_[column] = time_ns;
  sweep_->columnValid[column] = 1;
  readPixels(packet, packetColumn, column);
}

void SweepBuilder::readPixels(const std::uint8_t* packet, std::uint32_t packetColumn, std::uint32_t column) {
  const LidarProfile& profile = format_.profile();
  for (std::uint32_t row = 0; row < metadata_.rows; ++row) {
    const std::uint8_t* pixel = format_.pixel(packet, packetColumn, row);
    const std::size_t index = static_cast<std::size_t>(row) * columnCount_ + column;
    for (std::size_t i = 0; i < profile.echoes.size(); ++i) {
      const auto& fields = profile.echoes[i];
      auto& echo = sweep_->echoes[i];
      echo.range[index] = fields.range.read(pixel);
      if (fields.reflectivity.exists())
        echo.reflectivity[index] = static_cast<std::uint16_t>(fields.reflectivity.read(pixel));
      if (fields.signal.exists()) echo.signal[index] = static_cast<std::uint16_t>(fields.signal.read(pixel));
      if (fields.flags.exists()) echo.flags[index] = static_cast<std::uint8_t>(fields.flags.read(pixel));
    }
    if (profile.nearInfrared.exists())
      sweep_->nearInfrared[index] = static_cast<std::uint16_t>(profile.nearInfrared.read(pixel));
  }
}

obs::CObservationLidarSweep::Ptr SweepBuilder::finish() {
  if (!sweep_) return nullptr;
  auto sweep = std::move(sweep_);
  sweep_.reset();
  finishedFrameId_ = sweep->frameId;
  const auto missing = static_cast<std::uint64_t>(std::count(sweep->columnValid.begin(), sweep->columnValid.end(), 0));
  if (missing == columnCount_) {
    ++statistics_.emptySweeps;
    return nullptr;
  }
  if (missing > 0) {
    ++statistics_.incompleteSweeps;
    statistics_.missingColumns += missing;
    fillMissingTimes(sweep->columnValid);
  } else {
    sweep->columnValid.clear();
  }
  // Of a window that spans column 0 the turn may begin with the window's first column and not with column 0.
  const bool spansZero = metadata_.firstColumn > metadata_.lastColumn;
  const std::int64_t first_ns =
      spansZero ? *std::min_element(columnTime_ns_.begin(), columnTime_ns_.end()) : columnTime_ns_.front();
  sweep->timestamp = core::toMrptTime(first_ns + timeOffset_ns_);
  const std::int64_t start_ns =
      core::fromMrptTime(sweep->timestamp) - timeOffset_ns_;  // a whole tick, so times stay exact
  for (const std::int64_t time_ns : columnTime_ns_)
    sweep->columnTime_ns.push_back(static_cast<std::int32_t>(time_ns - start_ns));
  if (ownClock_) sweep->deviceTime_s = 1e-9 * static_cast<double>(start_ns);
  for (auto& echo : sweep->echoes)
    if (allZero(echo.flags)) echo.flags.clear();
  return sweep;
}

void SweepBuilder::fillMissingTimes(const std::vector<std::uint8_t>& valid) {
  const double period_ns = 1e9 / metadata_.turnRate_hz / metadata_.columns;
  const auto shifted = [period_ns](std::int64_t time_ns, std::size_t columns) {
    return time_ns + static_cast<std::int64_t>(std::llround(period_ns * static_cast<double>(columns)));
  };
  const auto firstAfter = [&valid](std::size_t column) {
    return static_cast<std::size_t>(std::find(valid.begin() + static_cast<std::ptrdiff_t>(column), valid.end(), 1) -
                                    valid.begin());
  };
  const std::size_t first = firstAfter(0);
  for (std::size_t column = 0; column < first; ++column)
    columnTime_ns_[column] = 2 * columnTime_ns_[first] - shifted(columnTime_ns_[first], first - column);
  for (std::size_t before = first; before < columnCount_;) {
    const std::size_t after = firstAfter(before + 1);
    for (std::size_t column = before + 1; column < after; ++column)
      if (after < columnCount_)
        columnTime_ns_[column] = columnTime_ns_[before] + (columnTime_ns_[after] - columnTime_ns_[before]) *
                                                              static_cast<std::int64_t>(column - before) /
                                                              static_cast<std::int64_t>(after - before);
      else
        columnTime_ns_[column] = shifted(columnTime_ns_[before], column - before);
    before = after;
  }
}

}  // namespace s2s::tools::ouster
