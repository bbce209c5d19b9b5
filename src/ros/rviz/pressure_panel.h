#pragma once

#ifndef Q_MOC_RUN
#include <diagnostic_msgs/DiagnosticArray.h>
#include <fsr_pressure_map/CalibrationInfo.h>
#include <fsr_pressure_map/Instruction.h>
#include <fsr_pressure_map/MatrixInfo.h>
#include <fsr_pressure_map/PressureMap.h>
#include <fsr_pressure_map/PressureStatisticsArray.h>
#include <fsr_pressure_map/Session.h>
#include <fsr_pressure_map/SurfaceCurvature.h>
#include <ros/node_handle.h>
#include <rviz/panel.h>
#include <sensor_msgs/FluidPressure.h>
#include <sensor_msgs/Image.h>

#include <functional>
#include <map>
#include <mutex>
#include <string>
#include <thread>
#include <vector>

#include "ros/rviz/panel_text.h"
#include "ros/rviz/pressure_gauge.h"
#endif

class QComboBox;
class QGridLayout;
class QHBoxLayout;
class QLabel;
class QLineEdit;
class QPushButton;
class QScrollArea;
class QTimer;
class QVBoxLayout;

namespace fsr_rviz {

/// Panel with the numbers of one sensor and with buttons for tare, reload, mask, checking the surface,
/// marking an event and setting an alarm, which are scrolled where the window is low. While a session is
/// conducted, it also shows the instruction, why the last attempt was rejected, the chamber's pressure beside
/// its target, the coverage, and the buttons for a person's answers, which stay in their places whatever is
/// said. All topics are in the sensor's namespace. A number that has not come yet, or not for 3 s, is shown
/// as "-", and a line below the buttons names the missing node. While limb_node adds up sheets and this
/// sensor is one of them, a line of sums and one for each sheet come first. Services are called in another
/// thread, so that the window never waits for them.
class PressurePanel : public rviz::Panel {
  Q_OBJECT

 public:
  explicit PressurePanel(QWidget* parent = nullptr);
  ~PressurePanel() override;

  void onInitialize() override;
  void load(const rviz::Config& config) override;
  void save(rviz::Config config) const override;

 private Q_SLOTS:
  void listen();
  void refresh();
  void showReply(const QString& reply);

 private:
  template <typename Message>
  struct Last {
    typename Message::ConstPtr message;
    ros::WallTime received;
    bool fresh() const;
  };
  struct Complaint {
    std::string sentence;
    ros::WallTime received;
  };
  void keepComplaints(const diagnostic_msgs::DiagnosticArray& diagnostics);
  void keepRest(const diagnostic_msgs::DiagnosticArray& diagnostics);
  void keepSheets(const diagnostic_msgs::DiagnosticStatus& status);
  template <typename Message>
  ros::Subscriber follow(const std::string& topic, Last<Message>& last);
  template <typename Message>
  void keep(const std::string& topic, Last<Message>& last);
  QLabel* addLine(QGridLayout* grid, const QString& name);
  void addNumbers(QGridLayout* grid);
  QPushButton* addButton(const char* label, QHBoxLayout* row, const std::function<void()>& pressed);
  void addButtons(QVBoxLayout* column);
  void addConductor(QVBoxLayout* column);
  void showConductor();
  void showGauge();
  static QLabel* addText(QVBoxLayout* column, const char* name);
  static QLabel* addFixedText(QVBoxLayout* column, const char* name, bool bold);
  void enableButtons();
  void forgetReply();
  void keepHeights();
  std::vector<std::size_t> selectedTaxels() const;
  void say(const QString& reply);
  void showStatistics();
  void showAlarms();
  void showRest();
  void showSheets(fsr::view::PressureUnit unit);
  void trigger(const std::string& what, const std::string& service);
  void answer(const std::string& what);
  void maskSelected();
  void markEvent();
  void setAlarm();
  void listRegions();
  void showWaiting();
  void call(const std::string& what, const std::function<std::string()>& service);
  template <typename Service>
  std::string answerOf(const std::string& service, Service& call);
  std::string name(const std::string& relative) const;

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
