#pragma once

/* The bytes that a board sends, and their encoder, in C99 for firmware: no allocation, no library, no
 * floating point, 64 bytes of tables. Copy this file and wire.c into one folder of a firmware project,
 * unchanged. docs/wire_format.md explains the format with a byte-exact example.
 *
 * A packet, little endian:
 *
 *     offset  bytes  field
 *          0      2  sync              0xA5 0x5A
 *          2      1  version           1
 *          3      1  type              FSR_WIRE_SCAN ...
 *          4      2  payload length n  [bytes]
 *          6      4  sequence          counts the packets of this type, wraps
 *         10      4  device time       [us], wraps after 71.6 minutes
 *         14      2  header check      CRC-16/CCITT-FALSE of bytes 2 to 13
 *         16      n  payload
 *     16 + n      4  packet check      CRC-32 (IEEE 802.3) of bytes 2 to 15 + n
 *
 * The header has its own check, so that a decoder knows the length to be right before it waits for that
 * many bytes. A corrupt length therefore never costs the valid packets behind it. */

#include <stddef.h>
#include <stdint.h>

#ifdef __cplusplus
extern "C" {
#endif

#define FSR_WIRE_SYNC_0 0xA5u
#define FSR_WIRE_SYNC_1 0x5Au
#define FSR_WIRE_VERSION 1u

/* Packet types. */
#define FSR_WIRE_SCAN 1u        /* device time = middle of the scan */
#define FSR_WIRE_TRANSDUCER 2u  /* device time = time of the sample */
#define FSR_WIRE_TEMPERATURE 3u /* device time = time of the sample */
#define FSR_WIRE_IDENTITY 4u    /* at start-up and about once a second; device time = now */
#define FSR_WIRE_TRIGGER 5u     /* within 0.1 s of an edge at the input; device time = the edge */

/* Sizes [bytes]. */
#define FSR_WIRE_HEADER_SIZE 16u
#define FSR_WIRE_CHECK_SIZE 4u
#define FSR_WIRE_OVERHEAD (FSR_WIRE_HEADER_SIZE + FSR_WIRE_CHECK_SIZE)
#define FSR_WIRE_TEXT_SIZE 16u
#define FSR_WIRE_SCAN_HEAD_SIZE 8u
#define FSR_WIRE_MAX_SIDE 64u
#define FSR_WIRE_SCAN_PAYLOAD(rows, columns) (FSR_WIRE_SCAN_HEAD_SIZE + 2u * (rows) * (columns))
#define FSR_WIRE_TRANSDUCER_PAYLOAD 4u
#define FSR_WIRE_TEMPERATURE_PAYLOAD 4u
#define FSR_WIRE_IDENTITY_PAYLOAD (3u * FSR_WIRE_TEXT_SIZE + 8u)
#define FSR_WIRE_TRIGGER_PAYLOAD 5u
#define FSR_WIRE_MAX_PAYLOAD FSR_WIRE_SCAN_PAYLOAD(FSR_WIRE_MAX_SIDE, FSR_WIRE_MAX_SIDE)
#define FSR_WIRE_MAX_PACKET (FSR_WIRE_OVERHEAD + FSR_WIRE_MAX_PAYLOAD)

/* Payload of a scan: rows u8, columns u8, full scale u16, duration u32, counts u16 each. */
typedef struct {
  uint8_t rows;           /* 1 to 64 */
  uint8_t columns;        /* 1 to 64 */
  uint16_t full_scale;    /* largest count that the converter can give, e.g. 4095 */
  uint32_t duration_us;   /* first to last taxel [us]; 0 = unknown */
  const uint16_t* counts; /* [rows x columns], row-major, none above full_scale */
} fsr_wire_scan;

/* Payload of an identity: three texts of 16 bytes (ASCII, padded with zeros), rows u8, columns u8,
 * full scale u16, scan period u32. */
typedef struct {
  const char* serial;   /* serial number; longer texts are cut at 16 bytes */
  const char* firmware; /* its version */
  const char* model;    /* of the board */
  uint8_t rows;
  uint8_t columns;
  uint16_t full_scale;
  uint32_t scan_period_us; /* [us]; 0 = unknown */
} fsr_wire_identity;

/* Each encoder writes one whole packet to `out` and returns its length [bytes]. It returns 0 and writes
 * nothing where the packet does not fit `capacity` or a scan violates the limits above. */
size_t fsr_wire_encode_scan(uint8_t* out, size_t capacity, uint32_t sequence, uint32_t time_us,
                            const fsr_wire_scan* scan);
/* `counts`: the transducer's raw reading; the receiver converts it to a pressure. */
size_t fsr_wire_encode_transducer(uint8_t* out, size_t capacity, uint32_t sequence, uint32_t time_us,
                                  int32_t counts);
/* `millidegrees`: [0.001 degree Celsius]. */
size_t fsr_wire_encode_temperature(uint8_t* out, size_t capacity, uint32_t sequence, uint32_t time_us,
                                   int32_t millidegrees);
size_t fsr_wire_encode_identity(uint8_t* out, size_t capacity, uint32_t sequence, uint32_t time_us,
                                const fsr_wire_identity* identity);
/* `high`: level of the input behind the edge, 0 or 1. `deviation_us`: the edge lies at most this far from
 * `time_us` [us]. */
size_t fsr_wire_encode_trigger(uint8_t* out, size_t capacity, uint32_t sequence, uint32_t time_us,
                               uint8_t high, uint32_t deviation_us);

/* CRC-16/CCITT-FALSE (polynomial 0x1021, start 0xFFFF): 0x29B1 for the text "123456789". */
uint16_t fsr_wire_crc16(const uint8_t* bytes, size_t size);
/* CRC-32 of IEEE 802.3 (zlib's): 0xCBF43926 for the text "123456789". */
uint32_t fsr_wire_crc32(const uint8_t* bytes, size_t size);

#ifdef __cplusplus
}
#endif
