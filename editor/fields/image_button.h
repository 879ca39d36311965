// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// A button that asks for an image and hands it on as a mask.

#include <QPushButton>
#include <functional>

#include "core/documents/mask_image.h"

namespace hairloom::editor {

/// `take` gets an image that could be read; what it fails with is said by `failed`, as is that it could not.
QPushButton* imageButton(const char* name, const QString& text, const QString& tip,
                         std::function<Status(const MaskImage&)> take,
                         std::function<void(const QString&)> failed);

}  // namespace hairloom::editor
