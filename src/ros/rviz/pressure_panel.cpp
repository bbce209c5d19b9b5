#ifndef Q_MOC_RUN
#include <diagnostic_msgs/DiagnosticArray.h>
#include <fsr_pressure_map/CalibrationInfo.h>
#include <fsr_pressure_map/Instruction.h>
#include <fsr_pressure_map/Mark.h>
#include <fsr_pressure_map/MatrixInfo.h>
#include <fsr_pressure_map/PressureMap.h>
#include <fsr_pressure_map/PressureStatisticsArray.h>
#include <fsr_pressure_map/Session.h>
#include <fsr_pressure_map/SetAlarm.h>
#include <fsr_pressure_map/SetMask.h>
#include <fsr_pressure_map/SurfaceCurvature.h>
#include <ros/node_handle.h>
#include <ros/service.h>
#include <rviz/panel.h>
#include <rviz/selection/selection_manager.h>
#include <rviz/visualization_manager.h>
#include <sensor_msgs/FluidPressure.h>
#include <sensor_msgs/Image.h>
#include <std_srvs/Trigger.h>

#include <QComboBox>
#include <QGridLayout>
#include <QHBoxLayout>
#include <QImage>
#include <QLabel>
#include <QLineEdit>
#include <QPixmap>
#include <QPushButton>
#include <QScrollArea>
#include <QTimer>
#include <QVBoxLayout>
#include <algorithm>
#include <cmath>
#include <functional>
#include <map>
#include <mutex>
#include <pluginlib/class_list_macros.hpp>
#include <set>
#include <string>
#include <thread>
#include <vector>

#include "dataset/recording_builder.h"
#include "fsr_pressure_map/view/colour_map.h"
#include "ros/live/calibration_health.h"
#include "ros/live/serve.h"
#include "ros/rviz/panel_text.h"
#include "ros/rviz/pressure_gauge.h"
#include "ros/rviz/taxel_selection.h"
#endif

namespace fsr_rviz {
namespace {

using fsr_pressure_map::PressureStatistics;

constexpr double kStale = 3.0;  // age after which a number is no longer shown [s]
constexpr int kRefresh = 200;   // [ms]
constexpr std::uint32_t kPanelQueue = 10;
constexpr double kReadable = 3.0;  // an answer stays this long after the instruction has changed [s]
constexpr int kLines = 3;          // the longest instruction has as many in a panel as wide as the coverage

// Whether a status is that of limb_node, and the topic `statistics` is that of one of its sheets.
bool isOfLimb(const diagnostic_msgs::DiagnosticStatus& status, const std::string& statistics) {
  const std::string task = std::string(": ") + fsr_ros::kSheetsTask;
  const auto is_it = [&](const auto& pair) { return pair.key + "/statistics" == statistics; };
  return QString::fromStdString(status.name).endsWith(QString::fromStdString(task)) &&
         std::any_of(status.values.begin(), status.values.end(), is_it);
}

// A widget that is scrolled upwards and downwards where it is higher than its place.
QScrollArea* scrolled(QWidget* content) {
  auto* area = new QScrollArea;
  area->setFrameShape(QFrame::NoFrame);
  area->setWidgetResizable(true);
  area->setHorizontalScrollBarPolicy(Qt::ScrollBarAlwaysOff);
  area->setWidget(content);
  return area;
}

}  // namespace

/// Panel with the numbers of one sensor and with buttons for tare, reload, mask, checking the surface,
/// marking an event and setting an alarm, which are scrolled where the window is low. While a session is
/// conducted, it also shows the instruction, why the last attempt was rejected, the chamber's pressure
/// beside its target, the coverage, and the buttons for a person's answers, which stay in their places
/// whatever is said. All topics are in the sensor's namespace. A number that has not come yet, or not for 3
/// s, is shown as "-", and a line below the buttons names the missing node. While limb_node adds up sheets
/// and this sensor is one of them, a line of sums and one for each sheet come first. Services are called in
/// another thread, so that the window never waits for them.
class PressurePanel : public rviz::Panel {
  Q_OBJECT

 public:
  explicit PressurePanel(QWidget* parent = nullptr) : Panel(parent) {
    auto* column = new QVBoxLayout;
    auto* grid = new QGridLayout;
    namespace_ = new QLineEdit("/fsr");
    namespace_->setObjectName("sensor");
    auto* sensor = new QGridLayout;
    sensor->addWidget(new QLabel("Sensor"), 0, 0);
    sensor->addWidget(namespace_, 0, 1);
    column->addLayout(sensor);
    addConductor(column);  // above everything whose height changes, so that its buttons stay in their places
    auto* content = new QWidget;
    auto* lines = new QVBoxLayout(content);
    lines->setContentsMargins(0, 0, 0, 0);
    sheets_text_ = addText(lines, "sheets");
    sheets_text_->hide();
    addNumbers(grid);
    lines->addLayout(grid);
    addButtons(lines);
    lines->addStretch(1);  // takes all free height, so that nothing above is spread when a text comes
    scroll_ = scrolled(content);
    scroll_->setMinimumHeight(40);  // [pixels]: all else has to fit beside the coverage of many surfaces
    column->addWidget(scroll_, 1);
    reply_ = addText(column, "reply");
    waiting_ = addText(column, "waiting");
    coverage_ = addText(column, "coverage");  // below the buttons: its height changes with the plan
    coverage_->hide();
    auto* warning = new QLabel("<b>Research use, not for diagnosis or fitting decisions</b>");
    warning->setWordWrap(true);
    column->addWidget(warning);
    setLayout(column);

    timer_ = new QTimer(this);
    connect(timer_, SIGNAL(timeout()), this, SLOT(refresh()));
    connect(namespace_, SIGNAL(editingFinished()), this, SLOT(listen()));
  }

  ~PressurePanel() override {
    {
      const std::lock_guard<std::mutex> lock(call_mutex_);
      ending_ = true;
      client_.shutdown();
    }
    if (caller_.joinable()) caller_.join();
  }

  void onInitialize() override {
    listen();
    timer_->start(kRefresh);
  }

  void load(const rviz::Config& config) override {
    Panel::load(config);
    QString value;
    if (config.mapGetString("Sensor", &value)) namespace_->setText(value);
    if (config.mapGetString("Unit", &value)) unit_->setCurrentText(value);
    config.mapGetFloat("Answers Shown (s)", &reply_shown_);
    listen();
  }

  void save(rviz::Config config) const override {
    Panel::save(config);
    config.mapSetValue("Sensor", namespace_->text());
    config.mapSetValue("Unit", unit_->currentText());
    config.mapSetValue("Answers Shown (s)", reply_shown_);
  }

 private Q_SLOTS:
  void listen() {
    subscribers_.clear();
    complaints_.clear();
    rest_values_.clear();
    sheets_.clear();
    try {
      subscribers_.push_back(handle_.subscribe<diagnostic_msgs::DiagnosticArray>(
          "/diagnostics", kPanelQueue, [this](const diagnostic_msgs::DiagnosticArrayConstPtr& all) {
            keepComplaints(*all);
            keepRest(*all);
          }));
      keep("chamber_pressure", last_chamber_);
      keep("curvature", last_surface_);
      keep("session", last_session_);
      keep("calibration_info", last_calibration_);
      keep("matrix_info", last_matrix_);
      keep("statistics", last_statistics_);
      keep("pressure_map", last_map_);
      keep("instruction", last_instruction_);
      keep("session_coverage", last_coverage_);
      shown_coverage_ = nullptr;
      reply_->clear();
    } catch (const ros::Exception& error) {
      subscribers_.clear();
      say(text(error.what()));
    }
    Q_EMIT configChanged();
  }

  void refresh() {
    forgetReply();
    chamber_->setText(last_chamber_.fresh()
                          ? text(fsr::view::pressureText(chamberPressure(), unit())) + " gauge"
                          : QString("-"));
    const auto& surface = last_surface_.message;
    surface_->setText(surface ? text(surface->x.empty() ? "unknown" : surface->surface) + ", " +
                                    (surface->mount > 0 ? QString::number(surface->mount) : QString("-"))
                              : QString("-"));
    const auto& session = last_session_.message;
    session_->setText(session
                          ? text(session->session_id) + " " + QString::fromStdString(session->subject_code)
                          : QString("-"));
    const auto& calibration = last_calibration_.message;
    calibration_->setText(calibration && !calibration->id.empty()
                              ? text(calibration->scheme) + ", " + text(calibration->id.substr(0, 12)) +
                                    correctionRemark(*calibration) +
                                    mapRemark(last_map_.fresh() ? last_map_.message : nullptr)
                              : QString("none"));
    calibration_->setToolTip(calibration ? QString::fromStdString(calibration->id) : QString());
    showStatistics();
    showSheets();
    showAlarms();
    showRest();
    showConductor();
    showWaiting();
    keepHeights();
  }

  void showReply(const QString& reply) {
    calling_ = false;
    enableButtons();
    const QString answered = answered_;
    say(reply);
    answered_ = answered;
  }

 private:
  template <typename Message>
  struct Last {
    typename Message::ConstPtr message;
    ros::WallTime received;
    bool fresh() const { return message && (ros::WallTime::now() - received).toSec() < kStale; }
  };
  struct Complaint {
    std::string sentence;
    ros::WallTime received;
  };

  // Keeps the errors of the sensor's driver, why no scans come, and those of the limb that the sensor is
  // on.
  void keepComplaints(const diagnostic_msgs::DiagnosticArray& diagnostics) {
    const std::string driver = handle_.resolveName(name("driver")).substr(1) + ":";
    for (const auto& status : diagnostics.status) {
      const bool limb = isOfLimb(status, handle_.resolveName(name("statistics")));
      if (limb) keepSheets(status);
      if (!limb && status.name.compare(0, driver.size(), driver) != 0) continue;
      if (status.level == diagnostic_msgs::DiagnosticStatus::ERROR) {
        complaints_[status.name] = {(limb ? "Sheets: " : "Driver: ") + status.message, ros::WallTime::now()};
      } else {
        complaints_.erase(status.name);
      }
    }
  }

  // Keeps what the sensor's calibration node says of the surface, and who publishes it.
  void keepRest(const diagnostic_msgs::DiagnosticArray& diagnostics) {
    const std::string calibration = handle_.resolveName(name("calibration")).substr(1) + ": calibration";
    for (const auto& status : diagnostics.status) {
      if (status.name != calibration) continue;
      rest_values_.clear();
      for (const auto& pair : status.values) rest_values_[pair.key] = pair.value;
      rest_received_ = ros::WallTime::now();
    }
  }

  // Listens to the sheets that limb_node names.
  void keepSheets(const diagnostic_msgs::DiagnosticStatus& status) {
    const bool known = std::all_of(status.values.begin(), status.values.end(),
                                   [this](const auto& pair) { return sheets_.count(pair.key) > 0; });
    if (known && sheets_.size() == status.values.size()) return;
    sheets_.clear();
    for (const auto& pair : status.values) {
      Sheet& sheet = sheets_[pair.key];
      sheet.subscribers = {follow(pair.key + "/statistics", sheet.statistics),
                           follow(pair.key + "/pressure_map", sheet.map)};
    }
  }

  template <typename Message>
  ros::Subscriber follow(const std::string& topic, Last<Message>& last) {
    last = {};
    const auto store = [&last](const typename Message::ConstPtr& message) {
      last.message = message;
      last.received = ros::WallTime::now();
    };
    return handle_.subscribe<Message>(topic, kPanelQueue, store);
  }

  template <typename Message>
  void keep(const std::string& topic, Last<Message>& last) {
    subscribers_.push_back(follow(name(topic), last));
  }

  QLabel* addLine(QGridLayout* grid, const QString& name) {
    const int row = grid->rowCount();
    auto* value = new QLabel("-");
    value->setObjectName(name);
    value->setWordWrap(true);
    grid->addWidget(new QLabel(name), row, 0, Qt::AlignTop);
    grid->addWidget(value, row, 1);
    return value;
  }

  void addNumbers(QGridLayout* grid) {
    chamber_ = addLine(grid, "Chamber");
    surface_ = addLine(grid, "Surface, mount");
    rest_ = addLine(grid, "Sheet at rest");
    session_ = addLine(grid, "Session");
    calibration_ = addLine(grid, "Calibration");
    peak_ = addLine(grid, "Peak");
    mean_ = addLine(grid, "Mean over contact");
    area_ = addLine(grid, "Contact area");
    force_ = addLine(grid, "Force");
    integral_ = addLine(grid, "Pressure x time");
    alarms_ = addLine(grid, "Alarms");
    for (QWidget* line : {rest_, calibration_, peak_, mean_, area_, force_, integral_, alarms_}) {
      results_.push_back(line);
      const int at = grid->indexOf(line);
      results_.push_back(grid->itemAt(at - 1)->widget());  // its name
    }
    unit_ = new QComboBox;
    for (const std::string& unit : fsr::view::pressureUnitNames())
      unit_->addItem(QString::fromStdString(unit));
    const int row = grid->rowCount();
    grid->addWidget(new QLabel("Unit"), row, 0);
    grid->addWidget(unit_, row, 1);
  }

  QPushButton* addButton(const char* label, QHBoxLayout* row, const std::function<void()>& pressed) {
    buttons_.push_back(new QPushButton(label));
    row->addWidget(buttons_.back());
    connect(buttons_.back(), &QPushButton::clicked, this, pressed);
    return buttons_.back();
  }

  void addButtons(QVBoxLayout* column) {
    auto* actions = new QHBoxLayout;
    auto* events = new QHBoxLayout;
    const auto ask = [this](const char* what, const char* service) {
      return [this, what, service] { trigger(what, service); };
    };
    addButton("Tare", actions, ask("tare", "calibration/tare"));
    addButton("Reload calibration", actions, ask("reload", "calibration/reload"));
    auto* taxels = new QHBoxLayout;  // a row of its own keeps the panel narrow
    addButton("Mask selected", taxels, [this] { maskSelected(); });
    addButton("Check surface", taxels, ask("check surface", "calibration/check_surface"));
    auto* estimate = new QHBoxLayout;
    estimate_ =
        addButton("Estimate surface", estimate, ask("estimate surface", "calibration/estimate_surface"));
    estimate_->hide();
    event_kind_ = new QComboBox;
    event_kind_->addItems({"note", "cycle_start", "conditioning", "don", "doff", "step", "sync", "reject"});
    event_label_ = new QLineEdit;
    event_label_->setObjectName("label");
    event_label_->setPlaceholderText("label");
    events->addWidget(event_kind_);
    events->addWidget(event_label_);
    addButton("Mark event", events, [this] { markEvent(); });
    auto* alarms = new QHBoxLayout;
    alarm_region_ = new QComboBox;
    alarm_region_->setObjectName("alarm region");
    alarm_region_->addItem("whole matrix");
    alarm_threshold_ = new QLineEdit;
    alarm_threshold_->setObjectName("alarm threshold");
    alarm_threshold_->setPlaceholderText("threshold, 0 = none");
    alarms->addWidget(alarm_region_);
    alarms->addWidget(alarm_threshold_);
    addButton("Set alarm", alarms, [this] { setAlarm(); });
    column->addLayout(actions);
    column->addLayout(taxels);
    column->addLayout(estimate);
    column->addLayout(events);
    column->addLayout(alarms);
  }

  void addConductor(QVBoxLayout* column) {
    conductor_ = new QWidget;
    conductor_->setObjectName("conductor");
    auto* lines = new QVBoxLayout;
    lines->setContentsMargins(0, 0, 0, 0);
    instruction_ = addFixedText(lines, "instruction", true);
    remark_ = addFixedText(lines, "remark", false);
    auto* answers = new QHBoxLayout;
    confirm_ = addButton("Confirm", answers, [this] { answer("confirm"); });
    addButton("Accept", answers, [this] { answer("accept"); });
    addButton("Reject", answers, [this] { answer("reject"); });
    addButton("Skip", answers, [this] { answer("skip"); });
    lines->addLayout(answers);
    gauge_ = new PressureGauge;
    gauge_->setObjectName("gauge");
    lines->addWidget(gauge_);
    conductor_->setLayout(lines);
    conductor_->hide();
    column->addWidget(conductor_);
  }

  void showConductor() {
    const bool conducted = last_instruction_.fresh();
    conductor_->setVisible(conducted);
    coverage_->setVisible(conducted);
    // A session needs no calibration. What has nothing to say makes room.
    for (QWidget* line : results_) line->setVisible(!conducted || last_statistics_.fresh());
    // A bar that comes and goes would change the width of the buttons.
    scroll_->setVerticalScrollBarPolicy(conducted ? Qt::ScrollBarAlwaysOn : Qt::ScrollBarAsNeeded);
    if (!conducted) return;
    showGauge();
    const fsr_pressure_map::Instruction& now = *last_instruction_.message;
    instruction_->setText(instructionText(now));
    instruction_->setToolTip(instruction_->text());
    const PanelLine remark = remarkLine(now);
    remark_->setText(remark.text);
    remark_->setToolTip(remark.text);
    remark_->setStyleSheet(remark.style);
    enableButtons();
    const sensor_msgs::Image::ConstPtr& picture = last_coverage_.message;
    if (picture == shown_coverage_ || picture == nullptr) return;
    shown_coverage_ = picture;
    if (picture->encoding != "rgb8" || picture->data.size() < std::size_t{picture->step} * picture->height)
      return;
    const QImage image(picture->data.data(), static_cast<int>(picture->width),
                       static_cast<int>(picture->height), static_cast<int>(picture->step),
                       QImage::Format_RGB888);
    coverage_->setPixmap(QPixmap::fromImage(image));
  }

  fsr::view::PressureUnit unit() const {
    return fsr::view::pressureUnitOf(unit_->currentText().toStdString());
  }

  // Gauge pressure of the last reading [Pa].
  double chamberPressure() const {
    const bool known = last_matrix_.message != nullptr;
    return last_chamber_.message->fluid_pressure -
           (known ? last_matrix_.message->ambient_pressure : fsr::dataset::kStandardAmbient);
  }

  void showGauge() {
    const double now = last_chamber_.fresh() ? chamberPressure() : std::nan("");
    const double target = target_.next(*last_instruction_.message, now);
    // Some room behind the highest peak, so that an overshoot is seen.
    full_ = std::fmax(full_, 1.1 * std::fmax(last_instruction_.message->peak, now));
    gauge_->show(now, target, full_, unit());
  }

  static QLabel* addText(QVBoxLayout* column, const char* name) {
    auto* text = new QLabel;
    text->setObjectName(name);
    text->setWordWrap(true);
    column->addWidget(text);
    return text;
  }

  // A text of a fixed height, with a scroll bar if it is longer: the buttons below it never move.
  static QLabel* addFixedText(QVBoxLayout* column, const char* name, bool bold) {
    auto* text = new QLabel;
    text->setObjectName(name);
    text->setWordWrap(true);
    text->setAlignment(Qt::AlignTop | Qt::AlignLeft);
    QFont font = text->font();
    font.setBold(bold);
    text->setFont(font);
    QScrollArea* frame = scrolled(text);
    frame->setFixedHeight(kLines * QFontMetrics(font).lineSpacing() + 2);
    column->addWidget(frame);
    return text;
  }

  // Confirm is grey where nothing is to be confirmed, and all buttons are while a service is called.
  void enableButtons() {
    for (QPushButton* button : buttons_) button->setEnabled(!calling_);
    const bool asked = last_instruction_.message && last_instruction_.message->confirm;
    confirm_->setEnabled(!calling_ && asked);
    confirm_->setToolTip(asked ? "The sheet lies on the surface that the instruction names."
                               : "Nothing is to be confirmed now.");
  }

  // An answer of the conductor also goes with the instruction that it belongs to.
  void forgetReply() {
    if (calling_) return;
    const double age = (ros::WallTime::now() - replied_).toSec();
    const bool over = !answered_.isEmpty() && instruction_->text() != answered_ && age > kReadable;
    if (age > double(reply_shown_) || over) reply_->clear();
  }

  // A layout takes a wrapped text for lower than it is, and squeezes other lines to make room for it:
  // buttons would move.
  void keepHeights() {
    for (QLabel* line : findChildren<QLabel*>()) {
      if (line == instruction_ || line == remark_ || !line->hasHeightForWidth()) continue;
      line->setMinimumHeight(0);  // else a text that was wrapped once keeps its height
      line->setMinimumHeight(std::max(0, line->heightForWidth(line->width())));
    }
  }

  // Taxels that the tool Select has picked, each once, as row-major indices.
  std::vector<std::size_t> selectedTaxels() const {
    std::set<std::size_t> taxels;
    if (vis_manager_ == nullptr) return {};
    rviz::SelectionManager* manager = vis_manager_->getSelectionManager();
    for (const auto& [handle, picked] : manager->getSelection()) {
      const auto* sheet = dynamic_cast<const TaxelSelection*>(manager->getHandler(handle));
      if (sheet == nullptr) continue;
      for (const std::size_t taxel : sheet->taxelsOf(picked)) taxels.insert(taxel);
    }
    return {taxels.begin(), taxels.end()};
  }

  void say(const QString& reply) {
    reply_->setText(reply);
    replied_ = ros::WallTime::now();
    answered_.clear();
  }

  void showStatistics() {
    PressureStatistics whole;
    const bool fresh = last_statistics_.fresh() && !last_statistics_.message->regions.empty();
    if (fresh) whole = last_statistics_.message->regions.front();
    const double none = std::nan("");
    const bool at_least = whole.saturated > 0;
    if (!fresh) whole.peak = none;
    peak_->setText(peakText(whole, last_map_.fresh() ? last_map_.message : nullptr, unit()));
    mean_->setText(text(fsr::view::limitText(fresh ? whole.mean : none, unit(), at_least)));
    area_->setText(number(fresh ? whole.contact_area : none, 1e-4, "cm\u00b2", 1));
    force_->setText((fresh && at_least ? ">= " : "") + number(fresh ? whole.force : none, 1, "N", 1));
    integral_->setText(number(fresh ? whole.pressure_time_integral : none, 1000, "kPa s", 0) +
                       (fresh ? QString(" in %1 s").arg(whole.duration, 0, 'f', 0) : QString()));
  }

  void showAlarms() {
    if (last_statistics_.fresh()) listRegions();
    const PanelLine line = alarmLine(last_statistics_.fresh() ? last_statistics_.message : nullptr,
                                     last_map_.fresh() ? last_map_.message : nullptr);
    alarms_->setText(line.text);
    alarms_->setStyleSheet(line.style);
  }

  void showRest() {
    if ((ros::WallTime::now() - rest_received_).toSec() > kStale) rest_values_.clear();
    const PanelLine line = restLine(rest_values_);
    rest_->setText(line.text);
    rest_->setStyleSheet(line.style);
    const auto source = rest_values_.find(fsr_ros::kCurvatureSourceKey);
    estimate_->setVisible(source != rest_values_.end() && source->second == fsr_ros::kCurvatureEstimated);
  }

  void showSheets() {
    sheets_text_->setVisible(!sheets_.empty());
    std::vector<SheetOfLimb> sheets;
    for (const auto& [name, sheet] : sheets_) {
      sheets.push_back({name, sheet.statistics.fresh() ? sheet.statistics.message : nullptr,
                        sheet.map.fresh() ? sheet.map.message : nullptr});
    }
    sheets_text_->setText(sheets.empty() ? QString() : sheetsText(sheets, unit()));
  }

  void trigger(const std::string& what, const std::string& service) {
    call(what, [this, service = name(service)] {
      std_srvs::Trigger trigger;
      return answerOf(service, trigger);
    });
  }

  // A person's answer to the conductor.
  void answer(const std::string& what) {
    trigger(what, "conduct/" + what);
    answered_ = instruction_->text();
  }

  void maskSelected() {
    const std::vector<std::size_t> taxels = selectedTaxels();
    if (taxels.empty() || !last_map_.fresh()) {
      say(taxels.empty() ? "Select taxels of the map with the tool Select first." : "No map has come.");
      return;
    }
    fsr_pressure_map::SetMask mask;
    mask.request.mask = maskAfter(last_map_.message->flags, taxels);
    call("mask",
         [this, service = name("calibration/set_mask"), mask]() mutable { return answerOf(service, mask); });
  }

  void markEvent() {
    fsr_pressure_map::Mark mark;
    mark.request.kind = event_kind_->currentText().toStdString();
    mark.request.label = event_label_->text().toStdString();
    call("mark", [this, service = name("session/mark"), mark]() mutable { return answerOf(service, mark); });
  }

  void setAlarm() {
    bool number = false;
    const double threshold = alarm_threshold_->text().trimmed().toDouble(&number);
    if (!number) {
      say("\"" + alarm_threshold_->text() + "\" is no threshold; give a number in " + unit_->currentText() +
          ", 0 = no alarm");
      return;
    }
    fsr_pressure_map::SetAlarm alarm;
    if (alarm_region_->currentIndex() > 0) alarm.request.region = alarm_region_->currentText().toStdString();
    alarm.request.threshold = threshold * fsr::view::pascals(unit());
    alarm.request.dwell = alarm.request.hysteresis = -1;  // as before
    call("set alarm",
         [this, service = name("view/set_alarm"), alarm]() mutable { return answerOf(service, alarm); });
  }

  // Regions that an alarm can be set for: the first one is the whole matrix.
  void listRegions() {
    QStringList names("whole matrix");
    for (std::size_t i = 1; i < last_statistics_.message->regions.size(); ++i) {
      names << QString::fromStdString(last_statistics_.message->regions[i].region);
    }
    QStringList shown;
    for (int i = 0; i < alarm_region_->count(); ++i) shown << alarm_region_->itemText(i);
    if (names == shown) return;
    alarm_region_->clear();
    alarm_region_->addItems(names);
  }

  // Every running node repeats its messages each second, so that a missing message means a missing node.
  void showWaiting() {
    QStringList lines;
    const auto want = [&](bool there, const char* topic, const char* what) {
      if (!there) lines << QString("Nothing on %1: %2").arg(text(handle_.resolveName(name(topic))), what);
    };
    const bool conducted = last_instruction_.fresh();
    want(conducted || last_calibration_.fresh(), "calibration_info",
         "tare and reload need the calibration node.");
    want(conducted || last_statistics_.fresh(), "statistics", "the numbers need the view node.");
    want(last_surface_.message != nullptr, "curvature", "the surface is unknown.");
    want(last_session_.fresh(), "session", "events can be marked while record.launch runs.");
    for (const auto& [status, complaint] : complaints_) {
      if ((ros::WallTime::now() - complaint.received).toSec() < kStale) lines << text(complaint.sentence);
    }
    waiting_->setText(lines.join("\n"));
  }

  void call(const std::string& what, const std::function<std::string()>& service) {
    if (caller_.joinable()) caller_.join();  // the last call has ended, or the buttons would be disabled
    calling_ = true;
    enableButtons();
    say(text(what) + " ...");
    caller_ = std::thread([this, service] {
      const QString reply = QString::fromStdString(service());
      QMetaObject::invokeMethod(this, "showReply", Qt::QueuedConnection, Q_ARG(QString, reply));
    });
  }

  // Calls a service and returns its message, or why it could not be called. The client is persistent, so
  // that the panel's end can cancel the call.
  template <typename Service>
  std::string answerOf(const std::string& service, Service& call) {
    if (!ros::service::exists(service, false)) return "there is no service " + service;
    ros::ServiceClient client;
    {
      const std::lock_guard<std::mutex> lock(call_mutex_);
      if (ending_) return "";
      client = client_ = handle_.serviceClient<Service>(service, true);
    }
    if (!client.call(call)) return service + " did not answer";
    return call.response.message;
  }

  std::string name(const std::string& relative) const {
    std::string result = namespace_->text().trimmed().toStdString();
    while (!result.empty() && result.back() == '/') result.pop_back();
    return result + "/" + relative;
  }

  ros::NodeHandle handle_;
  QLineEdit* namespace_;
  QComboBox* unit_;
  QLabel *chamber_, *surface_, *session_, *calibration_, *peak_, *mean_, *area_, *force_, *integral_,
      *alarms_, *rest_, *sheets_text_;
  QComboBox *event_kind_, *alarm_region_;
  QLineEdit *event_label_, *alarm_threshold_;
  std::vector<QPushButton*> buttons_;
  QPushButton* estimate_;  // one of them, shown where the calibration node publishes the curvature
  QLabel *reply_, *waiting_;
  QScrollArea* scroll_;            // numbers and buttons
  std::vector<QWidget*> results_;  // lines that need calibration and view node
  QWidget* conductor_;             // shown while a session is conducted
  PressureGauge* gauge_;
  PressureTarget target_;
  double full_ = 100e3;  // end of the gauge's bar, grows with the pressures [Pa]
  QLabel *instruction_, *remark_, *coverage_;
  QPushButton* confirm_;
  QTimer* timer_;

  std::vector<ros::Subscriber> subscribers_;
  Last<sensor_msgs::FluidPressure> last_chamber_;
  Last<fsr_pressure_map::SurfaceCurvature> last_surface_;
  Last<fsr_pressure_map::Session> last_session_;
  Last<fsr_pressure_map::CalibrationInfo> last_calibration_;
  Last<fsr_pressure_map::MatrixInfo> last_matrix_;
  Last<fsr_pressure_map::PressureStatisticsArray> last_statistics_;
  Last<fsr_pressure_map::PressureMap> last_map_;
  Last<fsr_pressure_map::Instruction> last_instruction_;
  Last<sensor_msgs::Image> last_coverage_;
  sensor_msgs::Image::ConstPtr shown_coverage_;
  ros::WallTime replied_;                        // when a service answered last
  float reply_shown_ = 60;                       // time for which its answer is shown [s]
  QString answered_;                             // instruction to which a person answered; empty = none
  bool calling_ = false;                         // a service is being called
  std::map<std::string, Complaint> complaints_;  // of the diagnostics, by the name of the status
  struct Sheet {
    Last<fsr_pressure_map::PressureStatisticsArray> statistics;
    Last<fsr_pressure_map::PressureMap> map;
    std::vector<ros::Subscriber> subscribers;
  };
  std::map<std::string, Sheet> sheets_;  // of the limb, by namespace; empty = this sensor is its only one
  DiagnosticValues rest_values_;         // of the calibration's diagnostics
  ros::WallTime rest_received_;
  std::thread caller_;
  std::mutex call_mutex_;
  ros::ServiceClient client_;  // of the service that is being called
  bool ending_ = false;
};

}  // namespace fsr_rviz

#include "pressure_panel.moc"

PLUGINLIB_EXPORT_CLASS(fsr_rviz::PressurePanel, rviz::Panel)
