#pragma once

#include <cstdint>

#include "ouster2rawlog/lidar_packet.h"
#include "ouster2rawlog/metadata.h"
#include "s2s/core/time.h"
#include "s2s/obs/CObservationLidarSweep.h"

namespace s2s::tools::ouster {

/// Collects the columns of LiDAR packets into sweeps.
///
/// An Ouster's encoder turns clockwise seen from above, so column m of M has the azimuth -2 pi m / M in the LiDAR's
/// frame, and a beam's azimuth offset counts clockwise too: it is stored with its sign turned. Rows are kept as the
/// device sends them ("staggered"), so that each column has one time. Only the columns of the azimuth window are kept,
/// unless the window spans column 0.
class SweepBuilder {
 public:
  struct Statistics {
    std::uint64_t lateColumns = 0;        ///< columns of a sweep that was already finished
    std::uint64_t impossibleColumns = 0;  ///< column number or time that cannot be
    std::uint64_t incompleteSweeps = 0;
    std::uint64_t missingColumns = 0;
    std::uint64_t emptySweeps = 0;  ///< sweeps without a valid column; not delivered
  };

  /// @param timeOffset_ns what to add to the device's clock to get UTC
  /// @param ownClock false if the device's clock is UTC already, so that it need not be kept beside it
  SweepBuilder(const Metadata& metadata, const LidarPacketFormat& format, std::int64_t timeOffset_ns, bool ownClock);

  /// The finished sweep when the packet begins the next one, else null. The sweep has neither label nor pose.
  obs::CObservationLidarSweep::Ptr add(const std::uint8_t* packet);
  /// The sweep that is under way, at the end of the data; null if there is none.
  obs::CObservationLidarSweep::Ptr finish();

  const Statistics& statistics() const { return statistics_; }

 private:
  void begin(std::uint32_t frameId);
  void addColumn(const std::uint8_t* packet, std::uint32_t packetColumn);
  void readPixels(const std::uint8_t* packet, std::uint32_t packetColumn, std::uint32_t column);
  /// Gives the columns that were not received a time too: between their neighbours', or by the rate of turn at an end.
  void fillMissingTimes(const std::vector<std::uint8_t>& valid);

  const Metadata& metadata_;
  const LidarPacketFormat& format_;
  std::int64_t timeOffset_ns_;
  bool ownClock_;
  std::uint32_t firstColumn_, columnCount_;
  obs::CObservationLidarSweep prototype_;  // geometry and sizes, without data
  obs::CObservationLidarSweep::Ptr sweep_;
  std::vector<std::int64_t> columnTime_ns_;  // device clock
  std::int64_t firstTime_ns_ = -1;           // of the first column that arrived
  std::int64_t finishedFrameId_ = -1;
  Statistics statistics_;
};

}  // namespace s2s::tools::ouster
