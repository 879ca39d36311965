// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// Dicts, lists and numbers of Python, NumPy's among them, as JSON and back. hairloom/_values.py does it.

#include <nanobind/nanobind.h>

#include <string>

namespace hairloom::python {

namespace nb = nanobind;

/// Throws hairloom.ArgumentError for what JSON has no word for.
std::string jsonOf(nb::handle value);
nb::object valueOfJson(const std::string& text);

/// A motion as makeMotion() names it. One that is given as a dict is a file for as long as this lives.
class MotionFile {
  public:
    explicit MotionFile(nb::handle motion);
    MotionFile(const MotionFile&) = delete;
    MotionFile& operator=(const MotionFile&) = delete;
    ~MotionFile();

    const std::string& name() const { return name_; }

  private:
    std::string name_;
    bool made_ = false;
};

}  // namespace hairloom::python
