#pragma once

#include "s2s/calib/options.h"
#include "s2s/core/option_table.h"

namespace s2s::calib {

/// The keys of [calibration].
core::OptionTable optionTable(CalibrationOptions& options);
/// The keys of [calibration.aperture].
core::OptionTable optionTable(ApertureOptions& options);
/// The keys of [calibration.mirror].
core::OptionTable optionTable(WaterMirrorOptions& options);
/// The keys of [calibration.texture].
core::OptionTable optionTable(TextureOptions& options);
/// The keys of [calibration.swath].
core::OptionTable optionTable(SwathOptions& options);

}  // namespace s2s::calib
