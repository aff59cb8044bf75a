#include "s2s/products/grid_files.h"

#include <cpl_conv.h>
#include <cpl_error.h>
#include <cpl_string.h>
#include <fcntl.h>
#include <gdal_priv.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <cstring>
#include <memory>
#include <mutex>

#include "s2s/core/atomic_file.h"
#include "s2s/core/error.h"

namespace s2s::products {

namespace {

constexpr double kNoData = -9999;

struct CloseDataset {
  void operator()(GDALDataset* dataset) const { GDALClose(dataset); }
};
using Dataset = std::unique_ptr<GDALDataset, CloseDataset>;

/// Collects what GDAL complains about on this thread, instead of letting it print.
class GdalMessages {
 public:
  GdalMessages() {
    static std::once_flag registered;
    std::call_once(registered, GDALAllRegister);
    CPLPushErrorHandlerEx(collect, &text_);
    CPLErrorReset();
  }
  ~GdalMessages() { CPLPopErrorHandler(); }
  GdalMessages(const GdalMessages&) = delete;
  GdalMessages& operator=(const GdalMessages&) = delete;

  std::string text() const { return text_.empty() ? "no reason given" : text_; }

 private:
  static void CPL_STDCALL collect(CPLErr level, CPLErrorNum, const char* message) {
    if (level >= CE_Failure) *static_cast<std::string*>(CPLGetErrorHandlerUserData()) = message;
  }
  std::string text_;
};

[[noreturn]] void failWriting(const std::string& path, const GdalMessages& messages) {
  throw core::OutputError("GDAL cannot write the grid: " + messages.text(), path,
                          "check the output folder and that the disk has room");
}

/// A band's values, first row northernmost as rasters have it; NaN becomes no-data.
template <class Value>
std::vector<float> northUp(const HeightGrid& grid, const std::vector<Value>& values) {
  std::vector<float> out;
  out.reserve(values.size());
  for (int row = grid.rows - 1; row >= 0; --row)
    for (int column = 0; column < grid.columns; ++column) {
      const auto value = static_cast<float>(values[grid.index(column, row)]);
      out.push_back(std::isnan(value) ? static_cast<float>(kNoData) : value);
    }
  return out;
}

bool writeBand(GDALDataset& dataset, int band, const std::string& name, std::vector<float> values) {
  GDALRasterBand* out = dataset.GetRasterBand(band);
  out->SetDescription(name.c_str());
  out->SetNoDataValue(kNoData);
  const int columns = dataset.GetRasterXSize(), rows = dataset.GetRasterYSize();
  return out->RasterIO(GF_Write, 0, 0, columns, rows, values.data(), columns, rows, GDT_Float32, 0, 0, nullptr) ==
         CE_None;
}

std::array<double, 6> geoTransform(const HeightGrid& grid) {
  return {grid.west_m, grid.cell_m, 0, grid.south_m + grid.rows * grid.cell_m, 0, -grid.cell_m};
}

/// BAG demands a reference that leads to geographic coordinates, and GDAL refuses a local one. This is a stand-in that
/// keeps metres as metres and says so in its name.
const char* bagCrsWkt() {
  return R"wkt(PROJCS["Seabed-to-Sky map frame, NOT georeferenced (stand-in around 0 N 0 E)",)wkt"
         R"wkt(GEOGCS["WGS 84",DATUM["WGS_1984",SPHEROID["WGS 84",6378137,298.257223563]],)wkt"
         R"wkt(PRIMEM["Greenwich",0],UNIT["degree",0.0174532925199433]],PROJECTION["Transverse_Mercator"],)wkt"
         R"wkt(PARAMETER["latitude_of_origin",0],PARAMETER["central_meridian",0],PARAMETER["scale_factor",1],)wkt"
         R"wkt(PARAMETER["false_easting",0],PARAMETER["false_northing",0],UNIT["metre",1],)wkt"
         R"wkt(AXIS["Easting",EAST],AXIS["Northing",NORTH]])wkt";
}

/// Fills a dataset that has room for `bands` of the grid's three bands.
bool fill(GDALDataset& dataset, const HeightGrid& grid, const std::string& crsWkt, int bands) {
  auto transform = geoTransform(grid);
  bool good = dataset.SetProjection(crsWkt.c_str()) == CE_None;
  good = good && dataset.SetGeoTransform(transform.data()) == CE_None;
  good = good && writeBand(dataset, 1, "height_m", northUp(grid, grid.height_m));
  good = good && writeBand(dataset, 2, "sigma_m", northUp(grid, grid.sigma_m));
  return good && (bands < 3 || writeBand(dataset, 3, "count", northUp(grid, grid.count)));
}

std::vector<float> readBand(GDALDataset& dataset, int band, const std::string& path, const GdalMessages& messages) {
  const int columns = dataset.GetRasterXSize(), rows = dataset.GetRasterYSize();
  std::vector<float> values(static_cast<std::size_t>(columns) * static_cast<std::size_t>(rows));
  GDALRasterBand* in = dataset.GetRasterBand(band);
  if (in->RasterIO(GF_Read, 0, 0, columns, rows, values.data(), columns, rows, GDT_Float32, 0, 0, nullptr) != CE_None)
    throw core::InputError("cannot read the grid: " + messages.text(), path, "write or copy the file anew");
  int hasNoData = 0;
  const auto noData = static_cast<float>(in->GetNoDataValue(&hasNoData));
  for (auto& value : values)
    if (hasNoData != 0 && value == noData) value = std::numeric_limits<float>::quiet_NaN();
  return values;
}

/// Turns the northernmost row first into the southernmost first.
std::vector<float> southUp(const HeightGrid& grid, const std::vector<float>& values) {
  std::vector<float> out(values.size());
  for (int row = 0; row < grid.rows; ++row)
    std::copy_n(values.begin() + static_cast<std::ptrdiff_t>(grid.index(0, grid.rows - 1 - row)), grid.columns,
                out.begin() + static_cast<std::ptrdiff_t>(grid.index(0, row)));
  return out;
}

}  // namespace

std::string localCrsWkt() {
  return R"wkt(LOCAL_CS["Seabed-to-Sky map frame (local, origin at the first keyframe, z up)",)wkt"
         R"wkt(UNIT["metre",1,AUTHORITY["EPSG","9001"]],AXIS["x",EAST],AXIS["y",NORTH]])wkt";
}

void writeGeoTiff(const std::string& path, const HeightGrid& grid) {
  if (grid.columns == 0 || grid.rows == 0)
    throw core::OutputError("the seabed grid has no cells", path, "switch the product off, or check the sonar layers");
  core::AtomicFile file(path);
  const GdalMessages messages;
  GDALDriver* driver = GetGDALDriverManager()->GetDriverByName("GTiff");
  CPLStringList options;
  options.SetNameValue("COMPRESS", "DEFLATE");
  options.SetNameValue("PREDICTOR", "3");
  options.SetNameValue("TILED", "YES");
  Dataset dataset(driver == nullptr ? nullptr
                                    : driver->Create(file.temporaryPath().c_str(), grid.columns, grid.rows, 3,
                                                     GDT_Float32, options.List()));
  if (!dataset || !fill(*dataset, grid, localCrsWkt(), 3)) failWriting(path, messages);
  dataset->SetMetadataItem("AREA_OR_POINT", "Area");
  dataset.reset();
  if (CPLGetLastErrorType() >= CE_Failure) failWriting(path, messages);
  file.commit();
}

namespace {

/// Proves that the disk has room for the file. HDF5, which writes it, crashes at the program's end after a failed
/// write.
void requireRoom(const std::string& temporaryPath, std::size_t bytes, const std::string& path) {
  const int file = ::open(temporaryPath.c_str(), O_CREAT | O_WRONLY | O_TRUNC | O_CLOEXEC, 0644);
  const int error = file < 0 ? errno : ::posix_fallocate(file, 0, static_cast<off_t>(bytes));
  if (file >= 0) ::close(file);
  ::unlink(temporaryPath.c_str());
  if (error != 0)
    throw core::OutputError("no room for the grid: " + std::string(std::strerror(error)), path,
                            "check that the disk has room and that you may write there");
}

/// Upper bound of a BAG's size: two uncompressed float layers in chunks of 100 x 100, metadata and HDF5's own tables.
std::size_t largestBag_bytes(const HeightGrid& grid) {
  constexpr std::size_t kChunk = 100, kOverhead_bytes = 512 * 1024;
  const auto padded = [](int n) { return (static_cast<std::size_t>(n) + kChunk - 1) / kChunk * kChunk; };
  return padded(grid.columns) * padded(grid.rows) * 2 * sizeof(float) + kOverhead_bytes;
}

}  // namespace

void writeBag(const std::string& path, const HeightGrid& grid, core::TimeNs surveyTime) {
  if (grid.columns == 0 || grid.rows == 0)
    throw core::OutputError("the seabed grid has no cells", path, "switch the product off, or check the sonar layers");
  core::AtomicFile file(path);
  requireRoom(file.temporaryPath(), largestBag_bytes(grid), path);
  const GdalMessages messages;
  GDALDriver* bag = GetGDALDriverManager()->GetDriverByName("BAG");
  GDALDriver* memory = GetGDALDriverManager()->GetDriverByName("MEM");
  if (bag == nullptr || memory == nullptr)
    throw core::OutputError("this GDAL cannot write BAG files", path,
                            "use a GDAL with HDF5, as Debian's is, or switch the product off");
  const Dataset source(memory->Create("", grid.columns, grid.rows, 2, GDT_Float32, nullptr));
  if (!source || !fill(*source, grid, bagCrsWkt(), 2)) failWriting(path, messages);
  const std::string date = core::formatUtc(surveyTime).substr(0, 10);
  CPLStringList options;
  options.SetNameValue("VAR_DATE", date.c_str());
  options.SetNameValue("VAR_DATETIME", core::formatUtc(surveyTime).substr(0, 19).c_str());
  options.SetNameValue("VAR_TITLE", "Seabed grid by Seabed-to-Sky");
  options.SetNameValue("VAR_ABSTRACT",
                       "Heights of the seabed, z up, in a local frame with its origin at the first keyframe");
  options.SetNameValue("VAR_VERT_UNCERT_CODE", "productUncert");
  options.SetNameValue("VAR_VERT_WKT",
                       "VERT_CS[\"Map frame height\",VERT_DATUM[\"First keyframe\",2005],"
                       "UNIT[\"metre\",1],AXIS[\"Height\",UP]]");
  Dataset dataset(bag->CreateCopy(file.temporaryPath().c_str(), source.get(), FALSE, options.List(), nullptr, nullptr));
  if (!dataset) failWriting(path, messages);
  dataset.reset();
  if (CPLGetLastErrorType() >= CE_Failure) failWriting(path, messages);
  file.commit();
}

HeightGrid readGrid(const std::string& path) {
  const GdalMessages messages;
  const Dataset dataset(GDALDataset::Open(path.c_str(), GDAL_OF_RASTER | GDAL_OF_READONLY));
  if (!dataset)
    throw core::InputError("cannot read the grid: " + messages.text(), path,
                           "check that it is a GeoTIFF of this program");
  std::array<double, 6> t{};
  if (dataset->GetGeoTransform(t.data()) != CE_None || t[2] != 0 || t[4] != 0 || t[1] <= 0 ||
      std::abs(t[1] + t[5]) > 1e-9 * t[1])
    throw core::InputError("the grid is not north up with square cells", path, "resample it first");
  const int rows = dataset->GetRasterYSize();
  HeightGrid grid(t[0], t[3] + rows * t[5], t[1], dataset->GetRasterXSize(), rows);
  grid.height_m = southUp(grid, readBand(*dataset, 1, path, messages));
  for (int band = 2; band <= dataset->GetRasterCount(); ++band) {
    const std::string name = dataset->GetRasterBand(band)->GetDescription();
    if (name == "sigma_m" || name == "uncertainty")
      grid.sigma_m = southUp(grid, readBand(*dataset, band, path, messages));
    if (name == "count") {
      const auto counts = southUp(grid, readBand(*dataset, band, path, messages));
      for (std::size_t i = 0; i < counts.size(); ++i)
        grid.count[i] = std::isnan(counts[i]) ? 0 : static_cast<std::uint32_t>(counts[i]);
    }
  }
  return grid;
}

}  // namespace s2s::products
