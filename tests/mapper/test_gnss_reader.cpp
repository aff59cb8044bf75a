#include <gtest/gtest.h>

#include "s2s/mapper/gnss_reader.h"

namespace s2s::mapper {
namespace {

mrpt::obs::CObservationGPS gga(double latitude_deg, double longitude_deg, double height_m, int quality = 1,
                               float hdop = 1) {
  mrpt::obs::gnss::Message_NMEA_GGA message;
  message.fields.latitude_degrees = latitude_deg;
  message.fields.longitude_degrees = longitude_deg;
  message.fields.altitude_meters = height_m;
  message.fields.fix_quality = static_cast<std::uint8_t>(quality);
  message.fields.HDOP = hdop;
  message.fields.thereis_HDOP = true;
  mrpt::obs::CObservationGPS observation;
  observation.timestamp = core::toMrptTime(1'733'400'000'000'000'000);
  observation.sensorPose.x(-0.35);
  observation.sensorPose.z(0.8);
  observation.setMsg(message);
  return observation;
}

TEST(GnssReader, FirstFix_IsTheOrigin) {
  GnssReader reader({});
  const auto fix = reader.read(gga(55.6617, 12.5736, 4));
  ASSERT_TRUE(fix);
  EXPECT_LT(fix->p_enu.norm(), 1e-6);
  EXPECT_TRUE(fix->p_vehicle_antenna.isApprox(Eigen::Vector3d(-0.35, 0, 0.8), 1e-12));
  EXPECT_EQ(fix->time, 1'733'400'000'000'000'000);
  EXPECT_EQ(reader.origin()->latitude_deg, 55.6617);
}

TEST(GnssReader, OneMinuteNorthAndEast_IsANauticalMileOrItsCosine) {
  GnssReader reader({});
  reader.read(gga(45, 12, 0));
  // On the ellipsoid a minute of latitude at 45 degrees is 1852.2 m; one of longitude 1314.2 m (a cos(lat) / sqrt(1 -
  // e^2 sin^2(lat)) * pi / 10800). Over a mile the earth curves 0.27 m down and turns the axes by 0.3 mrad.
  EXPECT_NEAR(reader.read(gga(45 + 1.0 / 60, 12, 0))->p_enu.y(), 1852.2, 0.5);
  EXPECT_NEAR(reader.read(gga(45, 12 + 1.0 / 60, 0))->p_enu.x(), 1314.2, 0.5);
  EXPECT_NEAR(reader.read(gga(45, 12, 7.5))->p_enu.z(), 7.5, 1e-6);
}

TEST(GnssReader, ToGeodetic_UndoesTheReading) {
  GnssReader reader({});
  reader.read(gga(-33.85, 151.2, 20));
  const auto fix = reader.read(gga(-33.8512345, 151.2023456, 23.5));
  const GeodeticPosition back = toGeodetic(fix->p_enu, *reader.origin());
  EXPECT_NEAR(back.latitude_deg, -33.8512345, 1e-9);  // 0.1 mm
  EXPECT_NEAR(back.longitude_deg, 151.2023456, 1e-9);
  EXPECT_NEAR(back.height_m, 23.5, 1e-4);
}

TEST(GnssReader, Sigma_FollowsQualityAndHdop) {
  const GnssReaderOptions options;
  GnssReader reader(options);
  EXPECT_DOUBLE_EQ(reader.read(gga(1, 1, 0, 1, 2.0F))->sigma_m.x(), 2 * options.sigmaSingle_m);
  EXPECT_DOUBLE_EQ(reader.read(gga(1, 1, 0, 4, 1.0F))->sigma_m.z(), options.heightFactor * options.sigmaFixed_m);
}

TEST(GnssReader, NoFix_IsNothing) {
  GnssReader reader({});
  EXPECT_FALSE(reader.read(gga(0, 0, 0, 0)));           // the receiver has none
  EXPECT_FALSE(reader.read(gga(55, 12, 0, 6)));         // dead reckoned
  EXPECT_FALSE(reader.read(gga(std::nan(""), 12, 0)));  // broken
  EXPECT_FALSE(reader.read(gga(91, 12, 0)));
  EXPECT_FALSE(reader.read(mrpt::obs::CObservationGPS()));
  EXPECT_FALSE(reader.origin());
}

}  // namespace
}  // namespace s2s::mapper
