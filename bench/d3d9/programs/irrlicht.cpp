// A scene of Irrlicht's Direct3D 9 driver with the models and pictures of its package: a map with light maps, animated
// models with shadow volumes, bump maps by its assembled shaders, a mirroring water, particles, a sky, a picture that
// is drawn to a texture, and its user interface. frames.h defines the arguments.
#include "frames.h"
#include <irrlicht.h>

using namespace irr;

namespace {

enum { WIDTH = 800, HEIGHT = 600, TARGET = 256, STEP = 20 }; // STEP: milliseconds between frames

struct Scene {
    IrrlichtDevice *device;
    video::IVideoDriver *driver;
    scene::ISceneManager *manager;
    scene::ICameraSceneNode *camera, *other;
    scene::ISceneNode *cube;
    video::ITexture *target;
};

void fail(const char *what)
{
    fprintf(stderr, "irrlicht: %s\n", what);
    exit(1);
}

void add_map(const Scene &scene)
{
    if (!scene.device->getFileSystem()->addFileArchive("media/map-20kdm2.pk3"))
        fail("no map");
    scene::IAnimatedMesh *mesh = scene.manager->getMesh("20kdm2.bsp");
    if (!mesh)
        fail("no mesh in the map");
    scene::ISceneNode *node = scene.manager->addOctreeSceneNode(mesh->getMesh(0), 0, -1, 1024);
    node->setPosition(core::vector3df(-1300, -144, -1249));
}

void add_figures(const Scene &scene)
{
    scene::IAnimatedMesh *sydney = scene.manager->getMesh("media/sydney.md2");
    scene::IAnimatedMesh *ninja = scene.manager->getMesh("media/ninja.b3d");
    if (!sydney || !ninja)
        fail("no figures");
    for (int i = 0; i < 3; i++) {
        scene::IAnimatedMeshSceneNode *node = scene.manager->addAnimatedMeshSceneNode(sydney);
        node->setMaterialTexture(0, scene.driver->getTexture("media/sydney.bmp"));
        node->setMD2Animation(i == 1 ? scene::EMAT_RUN : scene::EMAT_STAND);
        node->setPosition(core::vector3df(-40 + 50.0f * i, -42, 130 + 20.0f * i));
        node->setRotation(core::vector3df(0, 90 + 40.0f * i, 0));
        node->addShadowVolumeSceneNode();
    }
    scene::IAnimatedMeshSceneNode *node = scene.manager->addAnimatedMeshSceneNode(ninja);
    node->setScale(core::vector3df(6, 6, 6));
    node->setPosition(core::vector3df(-90, -66, 150));
    node->setAnimationSpeed(15);
}

void add_bumps(const Scene &scene)
{
    video::ITexture *bumps = scene.driver->getTexture("media/rockwall_height.bmp");
    if (!bumps)
        fail("no bumps");
    scene.driver->makeNormalMapTexture(bumps, 9.0f);
    scene::IMesh *plain = scene.manager->getGeometryCreator()->createSphereMesh(28, 32, 32);
    scene::IMesh *mesh = scene.manager->getMeshManipulator()->createMeshWithTangents(plain);
    const video::E_MATERIAL_TYPE kinds[2] = {video::EMT_NORMAL_MAP_SOLID, video::EMT_PARALLAX_MAP_SOLID};
    for (int i = 0; i < 2; i++) {
        scene::ISceneNode *node = scene.manager->addMeshSceneNode(mesh);
        node->setPosition(core::vector3df(-70 + 140.0f * i, 10, 190));
        node->setMaterialTexture(0, scene.driver->getTexture("media/rockwall.jpg"));
        node->setMaterialTexture(1, bumps);
        node->setMaterialType(kinds[i]);
        node->getMaterial(0).MaterialTypeParam = 0.035f;
        node->addAnimator(scene.manager->createRotationAnimator(core::vector3df(0, 0.5f, 0.2f)));
    }
}

void add_water(const Scene &scene)
{
    scene::IAnimatedMesh *plane = scene.manager->addHillPlaneMesh(
        "water", core::dimension2df(20, 20), core::dimension2du(30, 30), 0, 0, core::dimension2df(0, 0),
        core::dimension2df(10, 10));
    scene::ISceneNode *node = scene.manager->addWaterSurfaceSceneNode(plane->getMesh(0), 3.0f, 300.0f, 30.0f);
    node->setPosition(core::vector3df(0, -60, 200));
    node->setMaterialTexture(0, scene.driver->getTexture("media/stones.jpg"));
    node->setMaterialTexture(1, scene.driver->getTexture("media/water.jpg"));
    node->setMaterialType(video::EMT_REFLECTION_2_LAYER);
}

void add_fire(const Scene &scene)
{
    scene::IParticleSystemSceneNode *fire = scene.manager->addParticleSystemSceneNode(false);
    fire->setPosition(core::vector3df(10, -40, 170));
    scene::IParticleEmitter *emitter = fire->createBoxEmitter(
        core::aabbox3df(-7, 0, -7, 7, 1, 7), core::vector3df(0, 0.06f, 0), 80, 100, video::SColor(0, 255, 255, 255),
        video::SColor(0, 255, 255, 255), 800, 2000, 0, core::dimension2df(10, 10), core::dimension2df(20, 20));
    fire->setEmitter(emitter);
    emitter->drop();
    scene::IParticleAffector *fade = fire->createFadeOutParticleAffector();
    fire->addAffector(fade);
    fade->drop();
    fire->setMaterialFlag(video::EMF_LIGHTING, false);
    fire->setMaterialFlag(video::EMF_ZWRITE_ENABLE, false);
    fire->setMaterialTexture(0, scene.driver->getTexture("media/fire.bmp"));
    fire->setMaterialType(video::EMT_TRANSPARENT_ADD_COLOR);
}

void add_lights(const Scene &scene)
{
    const video::SColorf colors[2] = {video::SColorf(1.0f, 0.6f, 0.7f), video::SColorf(0.4f, 0.6f, 1.0f)};
    for (int i = 0; i < 2; i++) {
        scene::ILightSceneNode *light = scene.manager->addLightSceneNode(0, core::vector3df(0, 60, 100), colors[i], 400);
        light->addAnimator(scene.manager->createFlyCircleAnimator(core::vector3df(0, 80, 160), 90, i ? -0.002f : 0.001f));
        scene::ISceneNode *glow = scene.manager->addBillboardSceneNode(light, core::dimension2df(30, 30));
        glow->setMaterialFlag(video::EMF_LIGHTING, false);
        glow->setMaterialType(video::EMT_TRANSPARENT_ADD_COLOR);
        glow->setMaterialTexture(0, scene.driver->getTexture("media/particlewhite.bmp"));
    }
    scene.manager->setAmbientLight(video::SColorf(0.25f, 0.25f, 0.3f));
    scene.manager->setShadowColor(video::SColor(130, 0, 0, 0));
}

void add_sky(const Scene &scene)
{
    video::ITexture *sides[6];
    const char *const names[6] = {"up", "dn", "lf", "rt", "ft", "bk"};
    for (int i = 0; i < 6; i++) {
        char path[64];
        sprintf(path, "media/irrlicht2_%s.jpg", names[i]);
        sides[i] = scene.driver->getTexture(path);
    }
    scene.driver->setTextureCreationFlag(video::ETCF_CREATE_MIP_MAPS, false);
    scene.manager->addSkyBoxSceneNode(sides[0], sides[1], sides[2], sides[3], sides[4], sides[5]);
    scene.driver->setTextureCreationFlag(video::ETCF_CREATE_MIP_MAPS, true);
}

void add_target(Scene &scene)
{
    scene.target = scene.driver->addRenderTargetTexture(core::dimension2du(TARGET, TARGET), "target");
    if (!scene.target)
        fail("no target");
    scene.cube = scene.manager->addCubeSceneNode(30);
    scene.cube->setPosition(core::vector3df(50, -10, 120));
    scene.cube->setMaterialTexture(0, scene.target);
    scene.cube->setMaterialFlag(video::EMF_LIGHTING, false);
    scene.cube->addAnimator(scene.manager->createRotationAnimator(core::vector3df(0.3f, 0.3f, 0)));
    scene.other = scene.manager->addCameraSceneNode(0, core::vector3df(0, 40, 260), core::vector3df(0, -20, 100));
}

void add_interface(const Scene &scene)
{
    gui::IGUIEnvironment *gui = scene.device->getGUIEnvironment();
    gui->addStaticText(L"Irrlicht on Direct3D 9", core::recti(10, 10, 200, 30), true, true, 0, -1, true);
    gui->addButton(core::recti(10, 40, 110, 64), 0, -1, L"A button");
    gui->addImage(scene.driver->getTexture("media/irrlichtlogoalpha2.tga"), core::position2di(10, 500));
    gui->addCheckBox(true, core::recti(10, 70, 150, 90), 0, -1, L"A check box");
}

Scene open_scene()
{
    Scene scene = Scene();
    SIrrlichtCreationParameters parameters;
    parameters.DriverType = video::EDT_DIRECT3D9;
    parameters.WindowSize = core::dimension2du(WIDTH, HEIGHT);
    parameters.Stencilbuffer = true;
    parameters.Vsync = false;
    parameters.LoggingLevel = ELL_WARNING;
    scene.device = createDeviceEx(parameters);
    if (!scene.device)
        fail("no device");
    scene.driver = scene.device->getVideoDriver();
    scene.manager = scene.device->getSceneManager();
    scene.device->getTimer()->stop();
    scene.device->getTimer()->setTime(0);
    wprintf(L"renderer %ls\n", scene.driver->getName());
    add_map(scene);
    add_figures(scene);
    add_bumps(scene);
    add_water(scene);
    add_fire(scene);
    add_lights(scene);
    add_sky(scene);
    add_target(scene);
    add_interface(scene);
    scene.camera = scene.manager->addCameraSceneNode();
    return scene;
}

void draw_frame(const Scene &scene, long frame)
{
    const f32 angle = 0.01f * frame;
    scene.device->getTimer()->setTime(frame * STEP);
    scene.device->run();
    scene.camera->setPosition(core::vector3df(60 * sinf(angle), 15, -10 + 20 * cosf(angle)));
    scene.camera->setTarget(core::vector3df(0, -15, 150));
    scene.driver->beginScene(true, true, video::SColor(255, 60, 70, 90));
    scene.driver->setRenderTarget(scene.target, true, true, video::SColor(255, 0, 40, 80));
    scene.cube->setVisible(false);
    scene.manager->setActiveCamera(scene.other);
    scene.manager->drawAll();
    scene.driver->setRenderTarget(0);
    scene.cube->setVisible(true);
    scene.manager->setActiveCamera(scene.camera);
    scene.manager->drawAll();
    scene.device->getGUIEnvironment()->drawAll();
    scene.driver->endScene();
}

} // namespace

int main(int count, char **arguments)
{
    struct frames frames = frames_begin(count, arguments);
    const Scene scene = open_scene();
    // Particles depend on all frames before.
    for (long frame = 0; frames.picture && frame < frames.last; frame++)
        draw_frame(scene, frame);
    for (long frame; (frame = frames_next(&frames)) >= 0;)
        draw_frame(scene, frame);
    scene.device->drop();
    return 0;
}
