#include "ros/rviz/pressure_gauge.h"

#include <QPainter>
#include <algorithm>
#include <cmath>

namespace fsr_rviz {

namespace {

constexpr int kDigits = 60, kWords = 14, kBar = 26, kGap = 4;   // heights [pixels]
constexpr int kMarkWidth = 6;                                   // [pixels]
const QColor kFill(0x2a, 0x6f, 0xb5), kMark(0xd0, 0x5a, 0x00);  // told apart by colour-blind readers, too

}  // namespace

PressureGauge::PressureGauge(QWidget* parent) : QWidget(parent) {
  setFixedHeight(kDigits + kWords + kBar + 4 * kGap);
}

void PressureGauge::show(double now, double target, double full, fsr::view::PressureUnit unit) {
  now_ = now;
  target_ = target;
  full_ = full;
  unit_ = unit;
  const auto words = [unit](double value) {
    return QString::fromStdString(fsr::view::pressureText(value, unit));
  };
  setAccessibleName("now " + words(now) + ", target " + words(target));
  update();
}

void PressureGauge::paintEvent(QPaintEvent* /*event*/) {
  QPainter painter(this);
  QFont font = painter.font();
  const double pascals = fsr::view::pascals(unit_);
  const auto column = [&](const QString& name, double value, const QColor& colour, int left, int width) {
    font.setPixelSize(kWords);
    font.setBold(false);
    painter.setFont(font);
    painter.setPen(palette().windowText().color());
    painter.drawText(QRect(left, 0, width, kWords + kGap), Qt::AlignLeft, name);
    font.setPixelSize(kDigits);
    font.setBold(true);
    painter.setFont(font);
    painter.setPen(colour);
    const QString digits =
        std::isfinite(value) ? QString::number(std::lround(value / pascals)) : QString("-");
    painter.drawText(QRect(left, kWords + kGap, width, kDigits + kGap), Qt::AlignLeft | Qt::AlignVCenter,
                     digits);
  };
  const QString unit = " [" + QString::fromStdString(fsr::view::name(unit_)) + "]";
  column("now" + unit, now_, kFill, 0, width() / 2);
  column("target" + unit, target_, kMark, width() / 2, width() / 2);
  const QRect bar(0, kWords + kDigits + 3 * kGap, width(), kBar);
  const auto place = [&](double value) {
    return static_cast<int>(std::clamp(value / full_, 0.0, 1.0) * (bar.width() - kMarkWidth));
  };
  painter.fillRect(bar, palette().base());
  if (std::isfinite(now_))
    painter.fillRect(QRect(bar.left(), bar.top(), place(now_) + kMarkWidth / 2, kBar), kFill);
  if (std::isfinite(target_))
    painter.fillRect(QRect(bar.left() + place(target_), bar.top(), kMarkWidth, kBar), kMark);
  painter.setPen(palette().mid().color());
  painter.drawRect(bar.adjusted(0, 0, -1, -1));
}

namespace {

using fsr_pressure_map::Instruction;

constexpr double kNear = 0.05;  // of the way from `low` to `peak`, as a plan's usual tolerance of the peak

}  // namespace

double PressureTarget::next(const Instruction& instruction, double now) {
  if (step_ != instruction.step) *this = PressureTarget();
  step_ = instruction.step;
  const bool loads = instruction.kind == Instruction::CYCLE || instruction.kind == Instruction::CONDITION ||
                     instruction.kind == Instruction::LOOP || instruction.kind == Instruction::HOLD;
  const bool vents = instruction.kind == Instruction::REST || instruction.kind == Instruction::MOUNT ||
                     instruction.kind == Instruction::BREAK;
  if (instruction.confirm || vents) return 0;
  if (!loads || instruction.steps == 0) return NAN;
  if (instruction.kind == Instruction::HOLD) return instruction.peak;
  const double near = kNear * (instruction.peak - instruction.low);
  if (now >= instruction.peak - near) reached_ = true;
  if (reached_ && now < instruction.peak - near) down_ = true;
  if (down_ && now <= instruction.low + near) down_ = reached_ = false;  // the next attempt
  return down_ ? instruction.low : instruction.peak;
}

}  // namespace fsr_rviz
