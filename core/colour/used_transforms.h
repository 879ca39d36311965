// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// A look at what a transform leads to, before the library follows it: OpenColorIO 2.1 ends the program over a
// colour space that is defined by itself, and reads a device for ever.

#include <OpenColorIO/OpenColorIO.h>

#include "core/base/result.h"

namespace hairloom::colour {

/// Colour spaces, looks, views and files that `transform` uses, and those that they use. Errors: a colour
/// space that needs itself; a file that is none or is larger than 1 GiB. Names that are not there are the
/// library's to tell.
Status checkUsed(const OCIO_NAMESPACE::Config& config, const OCIO_NAMESPACE::ConstTransformRcPtr& transform);

}  // namespace hairloom::colour
