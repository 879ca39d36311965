// SPDX-License-Identifier: GPL-3.0-or-later
#include "editor/dialogs/manual_window.h"

#include <QAction>
#include <QDesktopServices>
#include <QFile>
#include <QGuiApplication>
#include <QHBoxLayout>
#include <QImage>
#include <QScrollBar>
#include <QSplitter>
#include <QTextBlock>
#include <QToolButton>
#include <QVBoxLayout>
#include <algorithm>
#include <map>

namespace hairloom::editor {
namespace {

constexpr QLatin1String kPages("qrc:/docs/");

/// Pictures are as wide as the page at most.
class Pages : public QTextBrowser {
  public:
    Pages() {
        setOpenLinks(false);
        setObjectName("manualText");
        setAccessibleName("Page");
    }

    QVariant loadResource(int type, const QUrl& name) override {
        const QVariant found = QTextBrowser::loadResource(type, name);
        if (type != QTextDocument::ImageResource) return found;
        const QImage picture = found.typeId() == QMetaType::QByteArray ? QImage::fromData(found.toByteArray())
                                                                       : found.value<QImage>();
        const int room = viewport()->width() - 48;
        if (picture.isNull() || picture.width() <= room) return picture.isNull() ? found : picture;
        return picture.scaledToWidth(std::max(room, 100), Qt::SmoothTransformation);
    }
};

}  // namespace

QString manualSection(const QString& panel) {
    static const std::map<QString, QString> sections{{"accuracy", "6-simulate"},
                                                     {"effects", "6-simulate"},
                                                     {"takes", "6-simulate"},
                                                     {"time_line", "6-simulate"},
                                                     {"layers", "layers"},
                                                     {"levels", "levels-of-detail"},
                                                     {"look", "7-look"},
                                                     {"motion", "6-simulate"},
                                                     {"operators", "operators"},
                                                     {"physics", "6-simulate"},
                                                     {"poses", "poses"},
                                                     {"scalp", "2-select-the-scalp"},
                                                     {"spheres", "5-fit-colliders"},
                                                     {"tool", "4-groom"},
                                                     {"view", "7-look"}};
    const auto found = sections.find(panel);
    return found == sections.end() ? QString() : found->second;
}

QString headingName(const QString& heading) {
    QString name;
    for (const QChar c : heading.toLower()) {
        if (c.isLetterOrNumber() || c == '-' || c == '_') name += c;
        if (c.isSpace()) name += '-';
    }
    return name;
}

ManualWindow::ManualWindow(QWidget* parent)
    : QDialog(parent), contents_(new QListWidget), text_(new Pages), search_(new QLineEdit) {
    setWindowTitle("Manual");
    setObjectName("manualWindow");
    resize(1060, 760);
    auto* layout = new QVBoxLayout(this);
    auto* bar = new QHBoxLayout;
    layout->addLayout(bar);
    const auto addStep = [&](const QString& words, const QKeySequence& key, void (QTextBrowser::*go)(),
                             void (QTextBrowser::*can)(bool)) {
        auto* step = new QToolButton;
        step->setText(words);
        step->setShortcut(key);
        step->setEnabled(false);
        step->setToolTip(QString("%1 (%2)").arg(words, key.toString(QKeySequence::NativeText)));
        connect(step, &QToolButton::clicked, text_, go);
        connect(text_, can, step, &QToolButton::setEnabled);
        bar->addWidget(step);
    };
    addStep("Back", QKeySequence("Alt+Left"), &QTextBrowser::backward, &QTextBrowser::backwardAvailable);
    addStep("Forward", QKeySequence("Alt+Right"), &QTextBrowser::forward, &QTextBrowser::forwardAvailable);
    bar->addStretch(1);
    search_->setObjectName("manualSearch");
    search_->setPlaceholderText("Find on this page");
    search_->setToolTip("Enter finds the next place, Shift+Enter the one before");
    search_->setAccessibleName("Find on this page");
    search_->setClearButtonEnabled(true);
    search_->setMaximumWidth(280);
    bar->addWidget(search_, 1);
    auto* focusSearch = new QAction(this);
    focusSearch->setShortcut(QKeySequence::Find);
    addAction(focusSearch);
    connect(focusSearch, &QAction::triggered, search_, qOverload<>(&QWidget::setFocus));
    auto* split = new QSplitter;
    contents_->setObjectName("manualContents");
    contents_->setAccessibleName("Contents");
    contents_->setHorizontalScrollBarPolicy(Qt::ScrollBarAlwaysOff);
    split->addWidget(contents_);
    split->addWidget(text_);
    split->setStretchFactor(1, 1);
    split->setSizes({220, 840});
    layout->addWidget(split, 1);
    connect(text_, &QTextBrowser::anchorClicked, this, &ManualWindow::follow);
    connect(text_, &QTextBrowser::sourceChanged, this, &ManualWindow::fillContents);
    connect(contents_, &QListWidget::currentItemChanged, this, [this](const QListWidgetItem* item) {
        if (item) goTo(item->data(Qt::UserRole).toInt());
    });
    connect(search_, &QLineEdit::returnPressed, this,
            [this] { search((QGuiApplication::keyboardModifiers() & Qt::ShiftModifier) != 0); });
}

void ManualWindow::open(const QString& page, const QString& heading) {
    const QUrl url(kPages + page);
    // The width of the page is that of its pictures.
    show();
    raise();
    activateWindow();
    if (text_->source() != url) text_->setSource(url, QTextDocument::MarkdownResource);
    goTo(std::max(0, blockOf(heading)));
    text_->setFocus();
}

void ManualWindow::follow(const QUrl& link) {
    const QUrl target = text_->source().resolved(link);
    if (target.scheme() != "qrc") {
        QDesktopServices::openUrl(target);
        return;
    }
    const QString page = target.adjusted(QUrl::RemoveFragment).toString().mid(kPages.size());
    if (!page.endsWith(".md") || !QFile::exists(":/docs/" + page)) return;
    open(page, target.fragment());
}

void ManualWindow::fillContents() {
    const QSignalBlocker quiet(contents_);
    contents_->clear();
    for (QTextBlock block = text_->document()->begin(); block.isValid(); block = block.next()) {
        const int level = block.blockFormat().headingLevel();
        if (level == 0 || block.text().isEmpty()) continue;
        auto* item = new QListWidgetItem(QString(2 * std::max(0, level - 1), ' ') + block.text(), contents_);
        item->setData(Qt::UserRole, block.blockNumber());
        item->setToolTip(block.text());
    }
}

void ManualWindow::goTo(int block) {
    const QTextBlock at = text_->document()->findBlockByNumber(block);
    text_->setTextCursor(QTextCursor(at));
    // To the top of the page, not just into it.
    QScrollBar& bar = *text_->verticalScrollBar();
    bar.setValue(bar.value() + text_->cursorRect().top() - 8);
}

int ManualWindow::blockOf(const QString& heading) const {
    if (heading.isEmpty()) return -1;
    for (QTextBlock block = text_->document()->begin(); block.isValid(); block = block.next()) {
        if (block.blockFormat().headingLevel() > 0 && headingName(block.text()) == heading)
            return block.blockNumber();
    }
    return -1;
}

void ManualWindow::search(bool backwards) {
    const QTextDocument::FindFlags flags =
        backwards ? QTextDocument::FindBackward : QTextDocument::FindFlags();
    if (search_->text().isEmpty() || text_->find(search_->text(), flags)) return;
    // Round again from the other end.
    text_->moveCursor(backwards ? QTextCursor::End : QTextCursor::Start);
    text_->find(search_->text(), flags);
}

}  // namespace hairloom::editor
