// SPDX-License-Identifier: GPL-3.0-or-later
// How many threads work together, for the kernels and for what dispatches them.
#ifndef HAIRLOOM_SHARED_GROUP_SIZES_H
#define HAIRLOOM_SHARED_GROUP_SIZES_H

#define HAIRLOOM_LIST_GROUP 64  // of kernels that work on a list
#define HAIRLOOM_TILE_GROUP 8   // along either side, of those that work on a picture
#define HAIRLOOM_COPY_GROUP 256
#define HAIRLOOM_COPY_ROW 65535            // groups of a dispatch that copies, along x
#define HAIRLOOM_SKY_THREADS_OF_STRAND 16  // that share a strand in sky_seen

#endif
