// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// A skinned character out of a binary glTF file, as one mesh of Ogre with a skeleton and its clips. A game
// has its own way to do this; hair asks of it no more than the names of bones.

#include <OgreMesh.h>

#include <string>

/// Of the material "skin". Throws std::runtime_error where the file cannot be used.
Ogre::MeshPtr loadCharacter(const std::string& file, const std::string& name);
