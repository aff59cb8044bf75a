#pragma once

#include "s2s/core/option_table.h"
#include "s2s/map/options.h"

namespace s2s::map {

/// INI keys of `[map]`, `[map.resolver]`, `[map.likelihood]` and `[map.view]`.
core::OptionTable optionTable(InsertionOptions& options);
core::OptionTable optionTable(ResolverOptions& options);
core::OptionTable optionTable(LikelihoodOptions& options);
core::OptionTable optionTable(ViewOptions& options);

}  // namespace s2s::map
