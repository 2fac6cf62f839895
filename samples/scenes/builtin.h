// SPDX-License-Identifier: MIT
#ifndef BUILTIN_H
#define BUILTIN_H

#include <pass/scene.h>

FG_BEGIN

// The built-in scenes, for the table in scenes.c. Errors: FG_ERR_MEMORY.
FG_NODISCARD fg_status cornell_build(const fg_log *log, ag_scene **out);
FG_NODISCARD fg_status atrium_build(const fg_log *log, ag_scene **out);
FG_NODISCARD fg_status living_room_build(const fg_log *log, ag_scene **out);
FG_NODISCARD fg_status maze_build(const fg_log *log, ag_scene **out);
FG_NODISCARD fg_status garden_build(const fg_log *log, ag_scene **out);
FG_NODISCARD fg_status factory_build(const fg_log *log, ag_scene **out);

FG_END

#endif // BUILTIN_H
