// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// RawStrands as bytes, for the pipe between hairloom-mesh-reader and its parent.

#include <span>
#include <string>

#include "importers/answer_stream.h"
#include "importers/raw_strands.h"

namespace hairloom {

/// The strands, or the reason why there are none; `lacking` names the layers of confinement that their reader
/// lacked.
void writeRawStrands(const Result<RawStrands>& strands, const std::string& lacking,
                     const AnswerWriter::Sink& sink);

/// What writeRawStrands() wrote. Errors: the error that was written, a message that the bytes are no strands,
/// or what checkRawStrands() says. `file` is named in errors.
Result<RawStrands> readRawStrands(const std::string& file, std::span<const std::byte> bytes,
                                  std::string& lacking);

/// Counts, lengths and indices fit each other: what passes is safe to use. Error: the first that does not.
Status checkRawStrands(const RawStrands& strands);

}  // namespace hairloom
