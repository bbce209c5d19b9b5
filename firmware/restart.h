#pragma once

/* Why the board started, as the text of its model: "mega power-on", "mega brown-out", "mega watchdog",
 * "mega reset pin", or "mega2560" where a boot loader has cleared the reason. */
const char* restart_reason(void);

/* The watchdog restarts the board when restart_postpone() was not called for a second. */
void restart_watch(void);
void restart_postpone(void);
