#pragma once

#include "wire.h"

/* Serial number: 16 bytes of ASCII at address 0 of the EEPROM, padded with zeros (`make identity`). An EEPROM
 * without a text gives DEFAULT_SERIAL. Boards with one serial number pass for the same board. */
#define DEFAULT_SERIAL "mega2560"

/* The identity of this board. Valid for ever. */
const fsr_wire_identity* identity_read(void);
