// A scene of Qt Quick for `make programs-gles`. Each frame turns it by a fixed angle, so frames do not depend
// on the time.
import QtQuick 2.15
import QtQuick.Window 2.15

Window {
    id: window
    visible: true
    width: 800
    height: 600
    color: "#204060"
    property int frame: 0
    onFrameSwapped: frame++

    Rectangle {
        x: 20; y: 20; width: 760; height: 60
        gradient: Gradient {
            GradientStop { position: 0; color: "crimson" }
            GradientStop { position: 1; color: "royalblue" }
        }
    }
    Repeater {
        model: 24
        Rectangle {
            readonly property real angle: (index * 15 + window.frame * 2) * Math.PI / 180
            x: 400 + 220 * Math.cos(angle) - 30; y: 340 + 200 * Math.sin(angle) - 30
            width: 60; height: 60; radius: 5 + index; rotation: index * 15 + window.frame * 3
            color: Qt.hsva(index / 24, 0.7, 0.9, 0.8)
            border { color: "white"; width: 2 }
            antialiasing: true
        }
    }
    Item {
        x: 330; y: 270; width: 140; height: 140
        layer.enabled: true
        layer.smooth: true
        rotation: -window.frame
        Rectangle { anchors.fill: parent; color: "orange"; opacity: 0.9 }
        Rectangle { x: 20; y: 20; width: 100; height: 100; radius: 50; color: "#203040"; clip: true }
    }
}
