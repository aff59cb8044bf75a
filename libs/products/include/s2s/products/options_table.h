#pragma once

#include "s2s/core/option_table.h"
#include "s2s/products/products_options.h"

namespace s2s::products {

/// The keys of `[products]`.
core::OptionTable optionTable(ProductsOptions& options);

}  // namespace s2s::products
