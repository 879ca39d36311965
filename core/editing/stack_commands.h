// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// Commands that change the stack of operators, with the hair that comes of it. They do nothing by
// themselves: Document::perform() carries them out. Each is null where nothing changes. Errors: an operator
// that cannot work on this hair, a place in the stack that there is not.

#include <memory>
#include <vector>

#include "core/editing/command.h"
#include "core/groom/groom.h"

namespace hairloom::editing {

using StackCommand = Result<std::unique_ptr<Command>>;

/// Before the one at `index`, or on top where there are as many. Its number, where it is a sculpt, is given
/// anew.
StackCommand addOperator(const Model& model, std::size_t index, Operator added);
StackCommand removeOperator(const Model& model, std::size_t index);
/// Takes it out and puts it where it then has index `to`.
StackCommand moveOperator(const Model& model, std::size_t from, std::size_t to);
/// Other settings, weight or muting. `name` is for the history: "Clump strength".
StackCommand setOperator(const Model& model, std::size_t index, Operator changed, std::string name);
/// Puts the same on top of it, with what was sculpted.
StackCommand copyOperator(const Model& model, std::size_t index);
/// Lets it act alone, or all again where it does so already.
StackCommand soloOperator(const Model& model, std::size_t index);
/// Before the one at `index`, or on top, in this order.
StackCommand addOperators(const Model& model, std::size_t index, std::vector<Operator> added,
                          std::string name);
/// All of them. A sculpt keeps the strokes that its number has; one without begins empty.
StackCommand setOperators(const Model& model, std::vector<Operator> operators, std::string name);
/// On top, a sculpt that makes the hair that shape where its weight is 1 and its mask whole. `shape` are the
/// points of all strands, with the roots that they have.
StackCommand addShape(const Model& model, std::span<const Vec3f> shape, Operator sculpt, std::string name,
                      std::string record);
/// The hair as it is becomes all there is.
StackCommand bakeOperators(const Model& model);

/// What has to follow a step that changed strands beside the stack. Null where nothing has to.
/// Strands came or went, or what masks read was painted: the stack runs again.
std::unique_ptr<Command> stackAfterStrands(const Model& model);
/// Brushes moved points of these strands (ascending): the topmost operator keeps it, where it is a sculpt
/// that is enabled and has its full weight and no mask, else a new one on top.
std::unique_ptr<Command> stackAfterStroke(const Model& model, std::span<const std::uint32_t> strands);

}  // namespace hairloom::editing
