#include "wire.h"

static uint8_t* put8(uint8_t* at, uint8_t value) {
  *at = value;
  return at + 1;
}

static uint8_t* put16(uint8_t* at, uint16_t value) {
  at = put8(at, (uint8_t)(value & 0xFFu));
  return put8(at, (uint8_t)(value >> 8));
}

static uint8_t* put32(uint8_t* at, uint32_t value) {
  at = put16(at, (uint16_t)(value & 0xFFFFu));
  return put16(at, (uint16_t)(value >> 16));
}

static uint8_t* put_text(uint8_t* at, const char* text) {
  size_t i;
  for (i = 0; i < FSR_WIRE_TEXT_SIZE; ++i) {
    at = put8(at, (uint8_t)*text);
    if (*text != '\0') ++text;
  }
  return at;
}

static size_t packet_size(size_t payload) {
  return FSR_WIRE_OVERHEAD + payload;
}

/* Writes the header; returns where the payload starts. */
static uint8_t* begin_packet(uint8_t* out, uint8_t type, size_t payload, uint32_t sequence,
                             uint32_t time_us) {
  uint8_t* at = out;
  at = put8(at, FSR_WIRE_SYNC_0);
  at = put8(at, FSR_WIRE_SYNC_1);
  at = put8(at, FSR_WIRE_VERSION);
  at = put8(at, type);
  at = put16(at, (uint16_t)payload);
  at = put32(at, sequence);
  at = put32(at, time_us);
  return put16(at, fsr_wire_crc16(out + 2, (size_t)(at - out) - 2));
}

/* Writes the packet check at `at`, behind the payload; returns the packet's length. */
static size_t end_packet(uint8_t* out, uint8_t* at) {
  at = put32(at, fsr_wire_crc32(out + 2, (size_t)(at - out) - 2));
  return (size_t)(at - out);
}

/* A packet whose payload is one signed number. */
static size_t encode_number(uint8_t* out, size_t capacity, uint8_t type, uint32_t sequence, uint32_t time_us,
                            int32_t value) {
  uint8_t* at;
  if (capacity < packet_size(4)) return 0;
  at = begin_packet(out, type, 4, sequence, time_us);
  return end_packet(out, put32(at, (uint32_t)value));
}

static int scan_is_sound(const fsr_wire_scan* scan) {
  return scan->rows >= 1 && scan->rows <= FSR_WIRE_MAX_SIDE && scan->columns >= 1 &&
         scan->columns <= FSR_WIRE_MAX_SIDE && scan->full_scale >= 1;
}

size_t fsr_wire_encode_scan(uint8_t* out, size_t capacity, uint32_t sequence, uint32_t time_us,
                            const fsr_wire_scan* scan) {
  const size_t taxels = (size_t)scan->rows * scan->columns;
  const size_t payload = FSR_WIRE_SCAN_HEAD_SIZE + 2 * taxels;
  uint8_t* at;
  size_t i;
  if (!scan_is_sound(scan) || capacity < packet_size(payload)) return 0;
  at = begin_packet(out, FSR_WIRE_SCAN, payload, sequence, time_us);
  at = put8(at, scan->rows);
  at = put8(at, scan->columns);
  at = put16(at, scan->full_scale);
  at = put32(at, scan->duration_us);
  for (i = 0; i < taxels; ++i) at = put16(at, scan->counts[i]);
  return end_packet(out, at);
}

size_t fsr_wire_encode_transducer(uint8_t* out, size_t capacity, uint32_t sequence, uint32_t time_us,
                                  int32_t counts) {
  return encode_number(out, capacity, FSR_WIRE_TRANSDUCER, sequence, time_us, counts);
}

size_t fsr_wire_encode_temperature(uint8_t* out, size_t capacity, uint32_t sequence, uint32_t time_us,
                                   int32_t millidegrees) {
  return encode_number(out, capacity, FSR_WIRE_TEMPERATURE, sequence, time_us, millidegrees);
}

size_t fsr_wire_encode_identity(uint8_t* out, size_t capacity, uint32_t sequence, uint32_t time_us,
                                const fsr_wire_identity* identity) {
  uint8_t* at;
  if (capacity < packet_size(FSR_WIRE_IDENTITY_PAYLOAD)) return 0;
  at = begin_packet(out, FSR_WIRE_IDENTITY, FSR_WIRE_IDENTITY_PAYLOAD, sequence, time_us);
  at = put_text(at, identity->serial);
  at = put_text(at, identity->firmware);
  at = put_text(at, identity->model);
  at = put8(at, identity->rows);
  at = put8(at, identity->columns);
  at = put16(at, identity->full_scale);
  at = put32(at, identity->scan_period_us);
  return end_packet(out, at);
}

size_t fsr_wire_encode_trigger(uint8_t* out, size_t capacity, uint32_t sequence, uint32_t time_us,
                               uint8_t high, uint32_t deviation_us) {
  uint8_t* at;
  if (capacity < packet_size(FSR_WIRE_TRIGGER_PAYLOAD)) return 0;
  at = begin_packet(out, FSR_WIRE_TRIGGER, FSR_WIRE_TRIGGER_PAYLOAD, sequence, time_us);
  at = put8(at, high != 0);
  return end_packet(out, put32(at, deviation_us));
}

uint16_t fsr_wire_crc16(const uint8_t* bytes, size_t size) {
  uint16_t crc = 0xFFFFu;
  size_t i;
  for (i = 0; i < size; ++i) {
    int bit;
    crc = (uint16_t)(crc ^ ((uint16_t)bytes[i] << 8));
    for (bit = 0; bit < 8; ++bit) {
      const uint16_t carry = (crc & 0x8000u) != 0 ? 0x1021u : 0;
      crc = (uint16_t)((uint16_t)(crc << 1) ^ carry);
    }
  }
  return crc;
}

/* Half a byte per step: the table takes 64 bytes of flash instead of the usual 1,024. */
uint32_t fsr_wire_crc32(const uint8_t* bytes, size_t size) {
  static const uint32_t table[16] = {
      0x00000000u, 0x1DB71064u, 0x3B6E20C8u, 0x26D930ACu, 0x76DC4190u, 0x6B6B51F4u, 0x4DB26158u, 0x5005713Cu,
      0xEDB88320u, 0xF00F9344u, 0xD6D6A3E8u, 0xCB61B38Cu, 0x9B64C2B0u, 0x86D3D2D4u, 0xA00AE278u, 0xBDBDF21Cu};
  uint32_t crc = 0xFFFFFFFFu;
  size_t i;
  for (i = 0; i < size; ++i) {
    crc = (crc >> 4) ^ table[(crc ^ bytes[i]) & 0x0Fu];
    crc = (crc >> 4) ^ table[(crc ^ ((uint32_t)bytes[i] >> 4)) & 0x0Fu];
  }
  return ~crc;
}
