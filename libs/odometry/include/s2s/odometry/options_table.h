#pragma once

#include "s2s/core/option_table.h"
#include "s2s/odometry/options.h"

namespace s2s::odometry {

/// Keys, help and limits of all the odometry's options, for an INI section such as [odometry].
core::OptionTable optionTable(OdometryOptions& options);

}  // namespace s2s::odometry
