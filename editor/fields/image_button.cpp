// SPDX-License-Identifier: GPL-3.0-or-later
#include "editor/fields/image_button.h"

#include <QFileDialog>

#include "editor/document/words.h"

namespace hairloom::editor {

QPushButton* imageButton(const char* name, const QString& text, const QString& tip,
                         std::function<Status(const MaskImage&)> take,
                         std::function<void(const QString&)> failed) {
    auto* button = new QPushButton(text);
    button->setObjectName(name);
    button->setToolTip(tip);
    QObject::connect(button, &QPushButton::clicked, button, [button, take = std::move(take), failed] {
        const QString path = QFileDialog::getOpenFileName(button, "Mask image", {}, "PNG (*.png)");
        if (path.isEmpty()) return;
        const auto image = MaskImage::read(path.toStdString());
        const Status taken = image ? take(*image) : tl::unexpected(image.error());
        if (!taken) failed(errorText(taken.error()));
    });
    return button;
}

}  // namespace hairloom::editor
