// SPDX-License-Identifier: MIT
#ifndef ROOM_H
#define ROOM_H

#include <pass/scene.h>

// A scene made by code: a floor and a wall under a point light.
FG_NODISCARD fg_status room_create(const fg_log *log, ag_scene **out);

#endif // ROOM_H
