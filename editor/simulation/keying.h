// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// Changes of the time line, each a step that can be undone, and keys at the play head.

#include <QObject>
#include <QString>

#include "core/groom/time_line_keys.h"
#include "editor/document/messages.h"
#include "editor/document/qt_document.h"
#include "editor/simulation/player.h"

namespace hairloom::editor {

/// "Wind speed" of a setting's track, else "Clips", "Head" or "Wind".
QString labelOf(const KeyTrack& track);

class Keying : public QObject {
    Q_OBJECT

  public:
    Keying(QtDocument& document, Player& player, Messages& messages, QObject* parent = nullptr);

    const TimeLine& line() const { return timeLineOf(document_.groom()); }
    /// False, with a word in the status line, where the time line cannot be so. Steps that follow each other
    /// with the same `mergeKey` are one; 0: a step of its own.
    bool change(TimeLine to, const QString& name, quint64 mergeKey = 0);

    // At the play head.

    /// Names of what keySetting() takes.
    std::vector<std::string> keyable() const { return keyableNames(document_.groom()); }
    /// The value that the document has.
    void keySetting(const std::string& name);
    void removeSetting(const std::string& name);
    /// As it is shown, and moved by hand.
    void keyHead();
    /// The settings' mean wind, as the wind tool sets it.
    void keyWind();
    /// A clip of the character, from the play head on.
    void addClip(const QString& clip);

    /// With the value that the track has at that time. Nothing for clips, and where a key is.
    void insertKey(const KeyTrack& track, float time);

    /// A key is within half a frame of the play head.
    bool hasKeyHere(const KeyTrack& track) const;
    std::size_t keyCount(const KeyTrack& track) const { return keyTimes(line(), track).size(); }
    Player& player() const { return player_; }

  Q_SIGNALS:
    /// The time line or the play head is another.
    void changed();
    /// The time line is, and before changed().
    void lineChanged();
    /// Another document has come, with its time line.
    void replaced();

  private:
    QtDocument& document_;
    Player& player_;
    Messages& messages_;
};

}  // namespace hairloom::editor
